// Reads a [[sonars]] table's own keys: kind, limits, bins, and what quality it is made with. Its
// terms, tables each, are read in scene_read_sonar_terms.cpp.
#include <algorithm>
#include <cmath>

#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr auto kKinds =
    std::to_array<SonarKind>({SonarKind::kImaging, SonarKind::kProfiling, SonarKind::kEchoSounder,
                              SonarKind::kSideScan, SonarKind::kMechanical});
constexpr auto kGathers = std::to_array<Key>({"plane", "nearest", "published"});
constexpr auto kQualities = std::to_array<Key>({"draft", "standard", "reference"});

constexpr double kMaxSonarRange_m = 20000.0;

void read_kind(TableReader& reader, Sonar& sonar) {
  std::vector<Key> names;
  for (const SonarKind kind : kKinds) names.push_back(name_of(kind));
  const std::string name = reader.choice("kind", name_of(sonar.kind), names);
  for (const SonarKind kind : kKinds)
    if (name == name_of(kind)) sonar.kind = kind;
}

void read_ranges(TableReader& reader, Sonar& sonar) {
  const std::vector<double> range =
      reader.numbers("range_m", {2}, {0, kMaxSonarRange_m, false, false, "metres"});
  if (range.size() != 2) return;
  sonar.range_min_m = range[0];
  sonar.range_max_m = range[1];
  if (!(range[0] < range[1]))
    reader.refuse("range_m", "[nearest, farthest], the nearest smaller than the farthest");
}

void read_bins(TableReader& reader, Sonar& sonar) {
  const Interval bin_count{1, double{kMaxSonarBins}};
  const std::vector<double> bins = reader.numbers("bins", {3}, bin_count);
  if (bins.size() != 3) return;
  for (const double n : bins)
    if (n != std::floor(n))
      reader.refuse("bins",
                    "whole numbers [range, azimuth, elevation], each in " + bin_count.text());
  sonar.bins_range = static_cast<std::uint32_t>(bins[0]);
  sonar.bins_azimuth = static_cast<std::uint32_t>(bins[1]);
  sonar.bins_elevation = static_cast<std::uint32_t>(bins[2]);
}

// An angle that only one kind of sonar has. Degrees; otherwise_deg where it is not named.
double angle_of_kind(TableReader& reader, const Sonar& sonar, Key key, SonarKind kind,
                     double otherwise_deg, const Interval& interval) {
  if (sonar.kind != kind && reader.has(key))
    reader.refuse(key, fmt::format("no such key for kind \"{}\"", name_of(sonar.kind)));
  return reader.number(key, otherwise_deg, interval);
}

// A cone is as wide as it is high: apertures that are named must be the cone's.
void check_cone(TableReader& reader, double semi_angle_deg) {
  for (const Key key : {"azimuth_deg", "elevation_deg"}) {
    const double aperture_deg = 2.0 * semi_angle_deg;
    if (std::abs(reader.number(key, aperture_deg, {0, 360}) - aperture_deg) > 1e-6)
      reader.refuse(key, fmt::format("none, or twice semi_angle_deg: {:g} for a cone of {:g}",
                                     aperture_deg, semi_angle_deg));
  }
}

void read_apertures(TableReader& reader, Sonar& sonar) {
  const double azimuth_deg = reader.number("azimuth_deg", 90.0, {0, 360, true, false, "degrees"});
  sonar.azimuth_rad = radians(azimuth_deg);
  sonar.elevation_rad =
      radians(reader.number("elevation_deg", 28.0, {0, 120, true, false, "degrees"}));

  const double semi_deg = angle_of_kind(reader, sonar, "semi_angle_deg", SonarKind::kEchoSounder,
                                        12.5, {0, 60, true, false, "degrees"});
  sonar.semi_angle_rad = radians(semi_deg);
  if (sonar.kind == SonarKind::kEchoSounder) check_cone(reader, semi_deg);

  sonar.depression_rad =
      radians(angle_of_kind(reader, sonar, "depression_deg", SonarKind::kSideScan, 35.0,
                            {0, 90, false, false, "degrees"}));

  // A scanner's azimuth bins are its steps.
  constexpr double kMaxStep_deg = 90.0;
  const bool counted = sonar.kind == SonarKind::kMechanical && reader.has("bins");
  const double step_deg = counted ? azimuth_deg / sonar.bins_azimuth : std::min(azimuth_deg, 1.0);
  sonar.step_rad = radians(angle_of_kind(reader, sonar, "step_deg", SonarKind::kMechanical,
                                         step_deg, {0, kMaxStep_deg, true, false, "degrees"}));
  if (sonar.step_rad > radians(kMaxStep_deg))
    reader.refuse(
        "bins", fmt::format("azimuth bins that make steps of at most {:g} degrees", kMaxStep_deg));
  if (sonar.kind == SonarKind::kMechanical && sonar.step_rad > sonar.azimuth_rad * (1.0 + 1e-9))
    reader.refuse("step_deg", fmt::format("at most azimuth_deg, {:g}: steps lie within the sector",
                                          azimuth_deg));
}

// Whether a key says how finely beams are sampled.
bool names_sampling(TableReader& reader) {
  for (const Key key : {"quality", "max_error", "gbuffer_scale", "gather"})
    if (reader.has(key)) return true;
  const TomlValue* beam = reader.find("beam");
  return beam != nullptr && beam->find("samples") != nullptr;
}

void read_quality(TableReader& reader, Sonar& sonar) {
  sonar.quality_chosen = !names_sampling(reader);
  sonar.gbuffer_scale = reader.number("gbuffer_scale", 0.0, {0, 16});
  sonar.gather = reader.choice("gather", "", kGathers);
  sonar.near_m = reader.number("near_m", 0.02, kNear);
  sonar.quality = reader.choice("quality", "", kQualities);
  if (!reader.has("max_error")) return;
  sonar.max_error = reader.number("max_error", 0.0, {0, 1, true, false});
  if (reader.has("quality")) reader.refuse("max_error", "no such key beside quality");
}

// Keys of detection that would have no effect.
void check_detection(TableReader& reader, const Sonar& sonar) {
  const SonarDetection& detection = sonar.terms.detection;
  const bool detects = sonar.kind == SonarKind::kProfiling ||
                       sonar.kind == SonarKind::kEchoSounder || sonar.kind == SonarKind::kSideScan;
  if (reader.has("detection") && !detects)
    reader.refuse("detection", fmt::format("no such key for kind \"{}\"", name_of(sonar.kind)));
  if (detection.quality > 0.0 && sonar.kind != SonarKind::kProfiling)
    reader.refuse("detection", "quality of kind \"profiling\" only");
  if (detection.pings != SonarDetection{}.pings && sonar.kind != SonarKind::kSideScan)
    reader.refuse("detection", "pings of kind \"sidescan\" only");
}

// A cone is one beam with one pattern about its axis, there and back.
void check_cone_beam(TableReader& reader, const SonarBeam& beam) {
  if (beam.azimuth && beam.elevation)
    reader.refuse("beam", "azimuth or elevation, not both, of kind \"echosounder\"");
  if (beam.two_way)
    reader.refuse("beam", "two_way of other kinds than \"echosounder\", which sends through it");
  if (beam.samples != SonarBeam{}.samples)
    reader.refuse("beam", "samples of other kinds than \"echosounder\", whose bins sample it");
}

// Requirements of a beam pattern on the sonar's kind.
void check_beam(TableReader& reader, const Sonar& sonar) {
  const SonarBeam& beam = sonar.terms.beam;
  const auto is_disc = [](const auto& pattern) {
    return pattern && pattern->shape == BeamShape::kPiston;
  };
  if ((is_disc(beam.azimuth) || is_disc(beam.elevation)) && sonar.kind != SonarKind::kEchoSounder)
    reader.refuse("beam", "piston, a disc, of kind \"echosounder\" only");
  if (sonar.kind == SonarKind::kEchoSounder) check_cone_beam(reader, beam);
  if (beam.steering == SonarBeam::Steering::kNone) return;
  if (sonar.kind != SonarKind::kImaging && sonar.kind != SonarKind::kProfiling)
    reader.refuse("beam", "steering of kinds \"imaging\" and \"profiling\" only");
  if (sonar.azimuth_rad > radians(170.0))
    reader.refuse("beam", "steering = \"flat\" of at most 170 degrees of azimuth");
}

}  // namespace

void read_sonar(TableReader& reader, Sonar& sonar) {
  read_kind(reader, sonar);
  read_ranges(reader, sonar);
  read_bins(reader, sonar);
  read_apertures(reader, sonar);
  sonar.rate_hz = reader.number("rate_hz", 10.0, kRate);
  sonar.picture_camera = reader.text("picture_camera", "");
  if (sonar.kind != SonarKind::kSideScan && reader.has("picture_camera"))
    reader.refuse("picture_camera",
                  fmt::format("no such key for kind \"{}\"", name_of(sonar.kind)));
  read_quality(reader, sonar);
  read_sonar_terms(reader, sonar.terms);
  check_beam(reader, sonar);
  check_detection(reader, sonar);
  // Shadow lies between rows that end on two surfaces: a beam without a footprint has no edges.
  if (sonar.gather == "nearest" && sonar.terms.labels.energy)
    reader.refuse("gather", "plane beside labels.energy: shadow needs a beam's footprint");
}

}  // namespace neritic::scene
