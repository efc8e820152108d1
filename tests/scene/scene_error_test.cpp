// Every wrong scene file ends in one line that names file, line and key, what was found and what is
// accepted: a table of wrong lines and their messages.
#include <gtest/gtest.h>

#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

struct WrongLine {
  const char* text;
  const char* message;
};

void PrintTo(const WrongLine& c, std::ostream* out) {
  *out << c.message;
}

class SceneError : public testing::TestWithParam<WrongLine> {};

TEST_P(SceneError, IsTheDocumentedLine) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(message_of(scratch, GetParam().text), GetParam().message);
}

std::string wrong_line_name(const testing::TestParamInfo<WrongLine>& info) {
  return test::test_name(info.index, info.param.message);
}

#define SPHERE "[[objects]]\nshape = \"sphere\"\n"
#define TURN "accepted: a number in [-360, 360] degrees"

INSTANTIATE_TEST_SUITE_P(
    Top, SceneError,
    testing::Values(
        WrongLine{"titel = 'x'", "s.toml:1: titel: unknown key; nearest known key: title"},
        WrongLine{"[[sonar]]", "s.toml:1: sonar: unknown key; nearest known key: sonars"},
        WrongLine{"title = 3", "s.toml:1: title: found 3; accepted: text on one line, in quotes"},
        WrongLine{"title = \"a\\nb\"",
                  "s.toml:1: title: found \"a?b\"; accepted: text on one line, in quotes"},
        WrongLine{"seed = -1",
                  "s.toml:1: seed: found -1; accepted: a whole number from 0 to "
                  "9223372036854775807"},
        WrongLine{"seed = 1.5",
                  "s.toml:1: seed: found 1.5; accepted: a whole number from 0 to "
                  "9223372036854775807"},
        WrongLine{"sun = true", "s.toml:1: sun: found true; accepted: a table, under [sun]"},
        WrongLine{"[sonars]",
                  "s.toml:1: sonars: found a table; accepted: tables, each under [[sonars]]"},
        WrongLine{"\n[sun]\nelevation_deg = 91",
                  "s.toml:3: sun.elevation_deg: found 91; accepted: a number in [-90, 90] degrees"},
        WrongLine{"[sun]\nazimuth_deg = inf", "s.toml:2: sun.azimuth_deg: found inf; " TURN},
        WrongLine{"[sun]\nazimuth_deg = 2024-01-01",
                  "s.toml:2: sun.azimuth_deg: found a date or time; " TURN},
        WrongLine{"[sun.caustics]\nwaves = []",
                  "s.toml:2: sun.caustics.waves: found []; accepted: 1 to 32 rows "
                  "[amplitude_m, wavelength_m, direction_deg]"},
        WrongLine{"[sun]\nintensity = 'high'",
                  "s.toml:2: sun.intensity: found \"high\"; accepted: a number in [0, 1000]"},
        WrongLine{"[sun]\nelevation = 3",
                  "s.toml:2: sun.elevation: unknown key; nearest known key: elevation_deg"},
        WrongLine{
            "[water]\ntype = '4C'",
            "s.toml:2: water.type: found \"4C\"; accepted: one of I, IA, IB, II, III, 1C, 3C, 5C, "
            "7C, 9C"},
        WrongLine{"[water]\nscattering = 1",
                  "s.toml:2: water.scattering: found 1; accepted: true or false"},
        WrongLine{"[water]\n[water.snow]\ndensity_m3 = 20000\nrange_m = 20",
                  "s.toml:4: water.snow.range_m: found 20; accepted: at most 6.2 m with 20000 "
                  "particles per cubic metre"},
        WrongLine{"[water]\nsurfaces = true",
                  "s.toml:2: water.surfaces: unknown key; nearest known key: surface"},
        WrongLine{"[classes]\nnet = 0",
                  "s.toml:2: classes.net: found 0; accepted: a whole number from 1 to 65532"},
        WrongLine{"[classes]\nnet = 65534",
                  "s.toml:2: classes.net: found 65534; accepted: a whole number from 1 to 65532"},
        WrongLine{
            "[classes]\nnet = 4",
            "s.toml:2: classes.net: found 4; accepted: a name and number of its own (class diver "
            "is "
            "4)"},
        WrongLine{
            "[classes]\ndiver = 40",
            "s.toml:2: classes.diver: found 40; accepted: a name and number of its own (class "
            "diver "
            "is 4)"}),
    wrong_line_name);

INSTANTIATE_TEST_SUITE_P(
    Object, SceneError,
    testing::Values(
        WrongLine{
            "[[objects]]\nname = 'a'",
            "s.toml:1: objects[0]: found none of model, shape, terrain; accepted: one of them"},
        WrongLine{SPHERE "model = 'x.glb'",
                  "s.toml:1: objects[0]: found more than one of model, shape, terrain; accepted: "
                  "one of them"},
        WrongLine{"[[objects]]\nmodel = 'x.glb'",
                  "s.toml:2: objects[0].model: found \"x.glb\"; accepted: a file; x.glb is none"},
        WrongLine{
            "[[objects]]\nshape = 'cone'",
            "s.toml:2: objects[0].shape: found \"cone\"; accepted: one of sphere, box, plane, "
            "cylinder"},
        WrongLine{SPHERE "radius = 2",
                  "s.toml:3: objects[0].radius: unknown key; nearest known key: radius_m"},
        WrongLine{
            SPHERE "radius_m = 0",
            "s.toml:3: objects[0].radius_m: found 0; accepted: a number in (0, 1000000] metres"},
        WrongLine{
            SPHERE "size_m = [1, 1, 1]",
            "s.toml:3: objects[0].size_m: found [1, 1, 1]; accepted: no such key for a sphere"},
        WrongLine{
            "[[objects]]\nshape = 'plane'\nsize_m = [1, 1, 1]",
            "s.toml:3: objects[0].size_m: found [1, 1, 1]; accepted: a list of 2 numbers, each in "
            "(0, 1000000] metres"},
        WrongLine{
            SPHERE "segments = 2",
            "s.toml:3: objects[0].segments: found 2; accepted: a whole number from 3 to 4096"},
        WrongLine{
            SPHERE "color = [1, 0, 1.5]",
            "s.toml:3: objects[0].color: found [1, 0, 1.5]; accepted: a list of 3 numbers, each in "
            "[0, 1]"},
        WrongLine{
            SPHERE "class = 'shrak'",
            "s.toml:3: objects[0].class: found \"shrak\"; accepted: one of seabed, rock, wreck, "
            "diver, rov, fish, shark, plant, coral, pipe, structure, target (nearest: shark), or a "
            "name under [classes]"},
        WrongLine{SPHERE "reflectivity = 2",
                  "s.toml:3: objects[0].reflectivity: found 2; accepted: a number in [0, 1]"},
        WrongLine{
            SPHERE "position_m = [0, nan, 0]",
            "s.toml:3: objects[0].position_m: found [0, nan, 0]; accepted: a list of 3 numbers, "
            "each in [-40000000, 40000000] metres"},
        WrongLine{
            SPHERE "position_m = [0, 1]",
            "s.toml:3: objects[0].position_m: found [0, 1]; accepted: a list of 3 numbers, each in "
            "[-40000000, 40000000] metres"},
        WrongLine{SPHERE "yaw_deg = 1\nlook_at_m = [1, 1, 1]",
                  "s.toml:1: objects[0]: found more than one attitude; accepted: one of yaw_deg "
                  "with pitch_deg "
                  "and roll_deg, rotation_xyzw, look_at_m, look_at"},
        WrongLine{
            SPHERE "rotation_xyzw = [0, 0, 0, 0]",
            "s.toml:3: objects[0].rotation_xyzw: found [0, 0, 0, 0]; accepted: a unit quaternion "
            "[x, y, z, w]"},
        WrongLine{SPHERE "scale = -1",
                  "s.toml:3: objects[0].scale: found -1; accepted: a number in (0, 1000000]"},
        WrongLine{
            SPHERE "scale = [1, 0, 1]",
            "s.toml:3: objects[0].scale: found [1, 0, 1]; accepted: a list of 3 numbers, each in "
            "(0, 1000000]"},
        WrongLine{
            SPHERE "name = 'a/b'",
            "s.toml:3: objects[0].name: found \"a/b\"; accepted: 1 to 64 letters, digits, _ and -"},
        WrongLine{
            SPHERE "name = 'a'\n" SPHERE "name = 'a'",
            "s.toml:6: objects[1].name: found \"a\" a second time; accepted: a name of its own"},
        WrongLine{
            SPHERE "clip = 'swim'",
            "s.toml:3: objects[0].clip: found \"swim\"; accepted: none, the model has no clips"},
        WrongLine{
            SPHERE "name = 'ball'\n" SPHERE "on = 'bal'",
            "s.toml:6: objects[1].on: found \"bal\"; accepted: the name of an object or vehicle "
            "(nearest: ball)"},
        WrongLine{SPHERE "name = 'a'\non = 'a'",
                  "s.toml:4: objects[0].on: found a, which hangs on itself through on or look_at; "
                  "accepted: no such "
                  "loop, at most 64 steps"},
        WrongLine{SPHERE "name = 'a'\nlook_at = 'a'",
                  "s.toml:4: objects[0].look_at: found a at the place from which it is looked at; "
                  "accepted: another place"},
        WrongLine{
            SPHERE "copies = [[1, 2]]",
            "s.toml:3: objects[0].copies: found [1, 2]; accepted: a list of 3, 4 or 5 numbers, "
            "each "
            "in [-40000000, 40000000] metres"},
        WrongLine{SPHERE "copies = []",
                  "s.toml:3: objects[0].copies: found []; accepted: one copy or more"},
        WrongLine{SPHERE "copies = [[0,0,0]]\nscatter = {area_m = [0,0,1,1]}",
                  "s.toml:1: objects[0]: found more than one of copies, copies_file, scatter; "
                  "accepted: one of "
                  "them"},
        WrongLine{
            SPHERE "copies_file = 'c.csv'",
            "s.toml:3: objects[0].copies_file: found \"c.csv\"; accepted: a file; c.csv is none"},
        WrongLine{
            SPHERE "normal_texture = 'x.png'",
            "s.toml:3: objects[0].normal_texture: found \"x.png\"; accepted: no such key for a "
            "sphere"},
        WrongLine{SPHERE "node = 'x'",
                  "s.toml:3: objects[0].node: found \"x\"; accepted: no such key for a sphere"}),
    wrong_line_name);

INSTANTIATE_TEST_SUITE_P(
    Scatter, SceneError,
    testing::Values(
        WrongLine{
            SPHERE "scatter = {count = 3}",
            "s.toml:3: objects[0].scatter.area_m: found nothing; accepted: [x0, z0, x1, z1] in "
            "metres"},
        WrongLine{
            SPHERE "scatter = {area_m = [1, 0, 0, 1]}",
            "s.toml:3: objects[0].scatter.area_m: found [1, 0, 0, 1]; accepted: [x0, z0, x1, z1] "
            "with x0 < x1 and z0 < z1"},
        WrongLine{SPHERE "scatter = {area_m = [0, 0, 1, 1], count = 0}",
                  "s.toml:3: objects[0].scatter.count: found 0; accepted: a whole number from 1 to "
                  "65535"},
        WrongLine{
            SPHERE "scatter = {area_m = [0, 0, 1, 1], on = 'sand'}",
            "s.toml:3: objects[0].scatter.on: found \"sand\"; accepted: the name of an object that "
            "is drawn, not scattered"},
        WrongLine{
            SPHERE "scatter = {area_m = [0, 0, 1, 1], on = 'rig'}\n[[objects]]\nname = 'rig'\n"
                   "lamps = [{}]",
            "s.toml:3: objects[0].scatter.on: found \"rig\"; accepted: the name of an object that "
            "is drawn, not scattered"},
        WrongLine{
            "[[objects]]\nlamps = [{}]\nradius_m = 3",
            "s.toml:3: objects[0].radius_m: found 3; accepted: no such key for what is not drawn"},
        WrongLine{
            "[[objects]]\nlamps = [{}]\nmaterial = 'steel'",
            "s.toml:3: objects[0].material: found \"steel\"; accepted: no such key for what is not "
            "drawn"},
        WrongLine{SPHERE "scatter = {area_m = [0, 0, 1, 1], aling = 'up'}",
                  "s.toml:3: objects[0].scatter.aling: unknown key; nearest known key: align"},
        WrongLine{SPHERE "on = 'x'\nscatter = {area_m = [0, 0, 1, 1]}",
                  "s.toml:3: objects[0].on: found \"x\"; accepted: no such key beside scatter"},
        WrongLine{SPHERE "scatter = {area_m = [0, 0, 1, 1], keep_out_m = [[0, 0, 9]]}",
                  "s.toml:3: objects[0].scatter: found no place for copy 0 of 1 in 256 attempts; "
                  "accepted: "
                  "an "
                  "area that the surface covers and keep_out_m leaves free"},
        WrongLine{SPHERE "copies = [[0,0,0]]\n" SPHERE
                         "scatter = {area_m = [0, 0, 1, 1], count = 65535}",
                  "s.toml:4: objects[1].name: found 65535 copies, which make 65536 instances in "
                  "all; accepted: at "
                  "most "
                  "65535 (16-bit labels)"}),
    wrong_line_name);

INSTANTIATE_TEST_SUITE_P(
    Sensor, SceneError,
    testing::Values(
        WrongLine{"[[cameras]]\nwidth = 0",
                  "s.toml:2: cameras[0].width: found 0; accepted: a whole number from 1 to 16384"},
        WrongLine{
            "[[cameras]]\nheight = 16385",
            "s.toml:2: cameras[0].height: found 16385; accepted: a whole number from 1 to 16384"},
        WrongLine{
            "[[cameras]]\nfov_deg = 170",
            "s.toml:2: cameras[0].fov_deg: found 170; accepted: a number in (1, 170) degrees"},
        WrongLine{"[[cameras]]\nnear_m = 0",
                  "s.toml:2: cameras[0].near_m: found 0; accepted: a number in (0, 10] metres"},
        WrongLine{
            "[[cameras]]\nexposure = 'bright'",
            "s.toml:2: cameras[0].exposure: found \"bright\"; accepted: \"auto\" or a number in "
            "[-30, 30] stops"},
        WrongLine{"[[cameras]]\nstereo_baseline = 0.06",
                  "s.toml:2: cameras[0].stereo_baseline: unknown key; nearest known key: "
                  "stereo_baseline_m"},
        WrongLine{
            "[[cameras]]\nlook_at = 'diver'",
            "s.toml:2: cameras[0].look_at: found \"diver\"; accepted: the name of an object or "
            "vehicle"},
        WrongLine{"[[cameras]]\nlook_at_m = [0, 0, 0]",
                  "s.toml:2: cameras[0].look_at_m: found [0, 0, 0]; accepted: a point other than "
                  "position_m"},
        WrongLine{
            "[[sonars]]\nrange_m = [5, 1]",
            "s.toml:2: sonars[0].range_m: found [5, 1]; accepted: [nearest, farthest], the nearest "
            "smaller than the farthest"},
        WrongLine{
            "[[sonars]]\nrange_m = [0, 20001]",
            "s.toml:2: sonars[0].range_m: found [0, 20001]; accepted: a list of 2 numbers, each in "
            "[0, 20000] metres"},
        WrongLine{
            "[[sonars]]\nrange_m = 5",
            "s.toml:2: sonars[0].range_m: found 5; accepted: a list of 2 numbers, each in [0, "
            "20000] metres"},
        WrongLine{
            "[[sonars]]\nazimuth_deg = 0",
            "s.toml:2: sonars[0].azimuth_deg: found 0; accepted: a number in (0, 360] degrees"},
        WrongLine{"[[sonars]]\nelevation_deg = 120.5",
                  "s.toml:2: sonars[0].elevation_deg: found 120.5; accepted: a number in (0, 120] "
                  "degrees"},
        WrongLine{
            "[[sonars]]\nbins = [500, 500, 0]",
            "s.toml:2: sonars[0].bins: found [500, 500, 0]; accepted: a list of 3 numbers, each in "
            "[1, 16384]"},
        WrongLine{
            "[[sonars]]\nbins = [500, 500, 2.5]",
            "s.toml:2: sonars[0].bins: found [500, 500, 2.5]; accepted: whole numbers [range, "
            "azimuth, elevation], each in [1, 16384]"},
        WrongLine{
            "[[sonars]]\nkind = 'side-scan'",
            "s.toml:2: sonars[0].kind: found \"side-scan\"; accepted: one of imaging, profiling, "
            "echosounder, sidescan, mechanical"},
        WrongLine{"[[sonars]]\ngather = 'linear'",
                  "s.toml:2: sonars[0].gather: found \"linear\"; accepted: one of plane, nearest, "
                  "published"},
        WrongLine{
            "[[sonars]]\nname = 'a'\n[[cameras]]\nname = 'a'",
            "s.toml:2: sonars[0].name: found \"a\" a second time; accepted: a name of its own"},
        WrongLine{
            "[[lamps]]\ncone_deg = [40, 20]",
            "s.toml:2: lamps[0].cone_deg: found [40, 20]; accepted: [inner, outer] half angles, "
            "the "
            "inner smaller than the outer"},
        WrongLine{"[[lamps]]\nintensity_cd = -1",
                  "s.toml:2: lamps[0].intensity_cd: found -1; accepted: a number in [0, 10000000] "
                  "candela"},
        WrongLine{
            "[[vehicles]]\nshape = 'box'\n[[vehicles.sonars]]\nrate_hz = 0",
            "s.toml:4: vehicles[0].sonars[0].rate_hz: found 0; accepted: a number in (0, 1000] "
            "hertz"},
        WrongLine{
            "[[vehicles]]\nshape = 'box'\n[[vehicles.sonars]]\non = 'x'",
            "s.toml:4: vehicles[0].sonars[0].on: found \"x\"; accepted: no such key here: it is "
            "mounted on vehicle_0"}),
    wrong_line_name);

}  // namespace
}  // namespace neritic::scene
