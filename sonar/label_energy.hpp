// Labels by energy: for every bin of a ping the class and instance that gave most of its energy,
// the part that they gave, and what only shows by its absence: shadow. All sums are exact integers:
// the same records give the same labels in any order of rays. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace neritic::sonar {

inline constexpr std::uint16_t kWater = 0;
inline constexpr std::uint16_t kGhost = 65533;   // a return that came by way of a mirror
inline constexpr std::uint16_t kShadow = 65534;  // behind something nearer, and silent

// What one ray brought. bin: its range row; kNoReturn where it hit nothing; any other bin beyond
// the image's last is a surface farther off, which neither sounds nor casts a shadow here.
inline constexpr std::uint32_t kNoReturn = 0xffffffff;
struct EnergyRecord {
  std::uint32_t bin;
  std::uint32_t counts;  // energy in fixed point; 0: the ray ended there without an echo
  std::uint16_t class_id, instance;
};
static_assert(sizeof(EnergyRecord) == 12 &&
              std::is_trivial_v<EnergyRecord>);  // as the GPU writes it

struct LabelImage {
  std::uint32_t n_range = 0, n_beams = 0;
  // [n_range][n_beams], row 0 nearest, column 0 full port.
  std::vector<std::uint16_t> classes;
  std::vector<std::uint16_t> instances;
  std::vector<float> fraction;  // of the bin's energy, above 0 to 1; 0 in water and shadow
};

// records: [n_elevation][n_columns]; n_columns = n_beams * samples_per_beam, the samples of a beam
// side by side; n_elevation is what the sizes leave (CHECKed to divide evenly). Rows may be ghosts'
// as well. Ties go to the smaller class, then instance. A bin without energy is kShadow where some
// ray of its beam ended nearer (ghosts aside: they are no surface), else kWater.
// Cost: one pass over the records; a bin that hears k different (class, instance) compares k keys.
LabelImage label_by_energy(std::span<const EnergyRecord> records, std::uint32_t n_range,
                           std::uint32_t n_beams, std::uint32_t samples_per_beam = 1);

}  // namespace neritic::sonar
