// How strongly the objects of a scene scatter sound back: the table by instance label that a gather
// with calibrated levels reads. Pure function; any thread.
#pragma once

#include <vector>

#include "engine/scene/scene.hpp"

namespace neritic::sonar {

// A body that scatters by Lambert's law with this strength (per square metre, at normal incidence)
// sends back as much as a rigid sphere of its size does at short wavelengths: the integral of
// mu cos^2 over the lit half sphere, 2 pi mu a^2 / 3, is the sphere's a^2 / 4 (Urick 1983, ch. 9).
inline constexpr double kRigidStrength = 3.0 / (8.0 * kPi);

struct BackscatterTable {
  std::vector<float> strength;  // by instance label, 0 to 1 of scale; 0 is label 0: nothing
  double scale = 1.0;           // mu of strength 1
};

// Strength of one object: its backscatter_db as 10^(dB / 10); else, of the class seabed, Lambert's
// -27 dB (Mackenzie 1961, a mean of many bottoms, here sand's), which its material scales by the
// energy it reflects over what sand does; of others a rigid body's, times their material's
// reflection squared; all times its reflectivity.
double backscatter_strength(const scene::Object& object);

BackscatterTable backscatter_table(const scene::Scene& scene);

// The plain cosine's factor by instance label; empty where every object's is 1.
std::vector<float> reflectivity_table(const scene::Scene& scene);

}  // namespace neritic::sonar
