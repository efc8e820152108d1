#include "engine/scene/sun_position.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/math.hpp"

namespace neritic::scene {

SunPosition sun_position(double latitude_rad, double day, double hour) {
  const double declination = radians(23.45) * std::sin(2.0 * kPi * (284.0 + day) / 365.0);
  const double turn = radians(15.0) * (hour - 12.0);
  const double sine = std::sin(latitude_rad) * std::sin(declination) +
                      std::cos(latitude_rad) * std::cos(declination) * std::cos(turn);
  // Components of the unit vector to the sun, towards east and north.
  const double east = -std::cos(declination) * std::sin(turn);
  const double north = std::cos(latitude_rad) * std::sin(declination) -
                       std::sin(latitude_rad) * std::cos(declination) * std::cos(turn);
  return {std::asin(std::clamp(sine, -1.0, 1.0)), std::atan2(east, north)};
}

}  // namespace neritic::scene
