// Where the sun stands, by latitude, day and hour. Pure.
#pragma once

namespace neritic::scene {

struct SunPosition {
  double elevation_rad = 0.0, azimuth_rad = 0.0;  // azimuth from north towards east
};

// day: of the year, 1 is the 1st of January. hour: local solar time, 12 is noon. Cooper 1969 (Solar
// Energy 12, 333) for the declination, within 1.6 degrees; no refraction of the air (0.6 degrees at
// the horizon).
SunPosition sun_position(double latitude_rad, double day, double hour);

}  // namespace neritic::scene
