// Labels by energy: for every bin of a ping the class and instance that gave most of its energy,
// the part that they gave, and what only shows by its absence: shadow. All sums are exact integers.
// Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace neritic::sonar {

inline constexpr std::uint16_t kWater = 0;
inline constexpr std::uint16_t kGhost = 65533;   // a return that came by way of a mirror
inline constexpr std::uint16_t kShadow = 65534;  // hidden by something nearer, and silent

// The echo of one ray. bin: the range row of its energy; kNoReturn if it hit nothing, kShared if
// its energy is shared evenly over the rows nearest to farthest; any other beyond the image's last
// row is a surface out of range, which gives no energy. nearest, farthest: the rows that the ray's
// height spans on its surface, with or without energy.
inline constexpr std::uint32_t kNoReturn = 0xffffffff, kShared = 0xfffffffe;
struct EnergyRecord {
  std::uint32_t bin;
  std::uint32_t counts;  // energy in fixed point; 0: the ray ended there without an echo
  std::uint16_t class_id, instance;
  std::uint16_t nearest, farthest;
};
static_assert(sizeof(EnergyRecord) == 16 &&
              std::is_trivial_v<EnergyRecord>);  // as the GPU writes it

struct LabelImage {
  std::uint32_t n_range = 0, n_beams = 0;
  // [n_range][n_beams], row 0 nearest, column 0 full port.
  std::vector<std::uint16_t> classes;
  std::vector<std::uint16_t> instances;
  // Part of the bin's energy, above 0 to 1; in shadow the part of the beam's columns, or of its
  // rays, that is hidden; 0 in water.
  std::vector<float> fraction;
};

// records: [n_elevation][n_columns], rows from one edge of the aperture to the other; n_columns =
// n_beams * samples_per_beam, the samples of a beam side by side; n_elevation is what the sizes
// leave (CHECKed to divide evenly). Further rows may be ghosts'. Ties go to the smaller class, then
// instance.
//
// Shadow is a silent bin that something nearer hides, in one of two ways. Two neighbouring rows of
// a column that end on surfaces with a jump of range between what they span hide what lies between,
// on the farther surface's continuation. (A jump is one of more than a bin and a quarter of both
// rows' spans: less is curvature.) And where more than half of what a beam hears by ended nearer
// than the bin, counted by weight, and none ends in it, it is hidden with nothing behind it to
// tell: behind what fills a beam all is shadow to the end of the range, beside a rope in open water
// all is water. weights: of the rays of the rows that are no ghosts', in the records' order; empty:
// all alike.
LabelImage label_by_energy(std::span<const EnergyRecord> records, std::uint32_t n_range,
                           std::uint32_t n_beams, std::uint32_t samples_per_beam = 1,
                           std::span<const std::uint8_t> weights = {});

}  // namespace neritic::sonar
