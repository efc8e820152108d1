// Every wrong scene file ends in one line that names file, line and key, what was found and what is
// accepted: a table of wrong lines and their messages.
#include <gtest/gtest.h>

#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

struct Case {
  const char* text;
  const char* message;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.message;
}

class SceneError : public testing::TestWithParam<Case> {};

TEST_P(SceneError, IsTheDocumentedLine) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(message_of(scratch, GetParam().text), GetParam().message);
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return test::test_name(info.index, info.param.message);
}

#define SPHERE "[[objects]]\nshape = \"sphere\"\n"
#define TURN "accepted: a number in [-360, 360] degrees"

INSTANTIATE_TEST_SUITE_P(
    Top, SceneError,
    testing::Values(
        Case{"titel = 'x'", "s.toml:1: titel: unknown key; nearest known key: title"},
        Case{"[[sonar]]", "s.toml:1: sonar: unknown key; nearest known key: sonars"},
        Case{"title = 3", "s.toml:1: title: found 3; accepted: text on one line, in quotes"},
        Case{"title = \"a\\nb\"",
             "s.toml:1: title: found \"a?b\"; accepted: text on one line, in quotes"},
        Case{"seed = -1",
             "s.toml:1: seed: found -1; accepted: a whole number from 0 to "
             "9223372036854775807"},
        Case{"seed = 1.5",
             "s.toml:1: seed: found 1.5; accepted: a whole number from 0 to "
             "9223372036854775807"},
        Case{"sun = true", "s.toml:1: sun: found true; accepted: a table, under [sun]"},
        Case{"[sonars]",
             "s.toml:1: sonars: found a table; accepted: tables, each under [[sonars]]"},
        Case{"\n[sun]\nelevation_deg = 91",
             "s.toml:3: sun.elevation_deg: found 91; accepted: a number in [0, 90] degrees"},
        Case{"[sun]\nazimuth_deg = inf", "s.toml:2: sun.azimuth_deg: found inf; " TURN},
        Case{"[sun]\nazimuth_deg = 2024-01-01",
             "s.toml:2: sun.azimuth_deg: found a date or time; " TURN},
        Case{"[sun]\nintensity = 'high'",
             "s.toml:2: sun.intensity: found \"high\"; accepted: a number in [0, 1000]"},
        Case{"[sun]\nelevation = 3",
             "s.toml:2: sun.elevation: unknown key; nearest known key: elevation_deg"},
        Case{"[water]\ntype = '4C'",
             "s.toml:2: water.type: found \"4C\"; accepted: one of I, IA, IB, II, III, 1C, 3C, 5C, "
             "7C, 9C"},
        Case{"[water]\nscattering = 1",
             "s.toml:2: water.scattering: found 1; accepted: true or false"},
        Case{"[water]\nsurfaces = true",
             "s.toml:2: water.surfaces: unknown key; nearest known key: surface"},
        Case{"[classes]\nnet = 0",
             "s.toml:2: classes.net: found 0; accepted: a whole number from 1 to 65535"},
        Case{"[classes]\nnet = 4",
             "s.toml:2: classes.net: found 4; accepted: a name and number of its own (class diver "
             "is "
             "4)"},
        Case{"[classes]\ndiver = 40",
             "s.toml:2: classes.diver: found 40; accepted: a name and number of its own (class "
             "diver "
             "is 4)"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Object, SceneError,
    testing::Values(
        Case{"[[objects]]\nname = 'a'",
             "s.toml:1: objects[0]: none of model, shape, terrain; accepted: one of them"},
        Case{SPHERE "model = 'x.glb'",
             "s.toml:1: objects[0]: more than one of model, shape, terrain; accepted: one of them"},
        Case{"[[objects]]\nmodel = 'x.glb'",
             "s.toml:2: objects[0].model: found \"x.glb\"; accepted: a file; x.glb is none"},
        Case{"[[objects]]\nshape = 'cone'",
             "s.toml:2: objects[0].shape: found \"cone\"; accepted: one of sphere, box, plane, "
             "cylinder"},
        Case{SPHERE "radius = 2",
             "s.toml:3: objects[0].radius: unknown key; nearest known key: radius_m"},
        Case{SPHERE "radius_m = 0",
             "s.toml:3: objects[0].radius_m: found 0; accepted: a number in (0, 1000000] metres"},
        Case{SPHERE "size_m = [1, 1, 1]",
             "s.toml:3: objects[0].size_m: found [1, 1, 1]; accepted: no such key for a sphere"},
        Case{"[[objects]]\nshape = 'plane'\nsize_m = [1, 1, 1]",
             "s.toml:3: objects[0].size_m: found [1, 1, 1]; accepted: a list of 2 numbers, each in "
             "(0, 1000000] metres"},
        Case{SPHERE "segments = 2",
             "s.toml:3: objects[0].segments: found 2; accepted: a whole number from 3 to 4096"},
        Case{
            SPHERE "color = [1, 0, 1.5]",
            "s.toml:3: objects[0].color: found [1, 0, 1.5]; accepted: a list of 3 numbers, each in "
            "[0, 1]"},
        Case{
            SPHERE "class = 'shrak'",
            "s.toml:3: objects[0].class: found \"shrak\"; accepted: one of seabed, rock, wreck, "
            "diver, rov, fish, shark, plant, coral, pipe, structure, target (nearest: shark), or a "
            "name under [classes]"},
        Case{SPHERE "reflectivity = 2",
             "s.toml:3: objects[0].reflectivity: found 2; accepted: a number in [0, 1]"},
        Case{SPHERE "position_m = [0, nan, 0]",
             "s.toml:3: objects[0].position_m: found [0, nan, 0]; accepted: a list of 3 numbers, "
             "each in [-40000000, 40000000] metres"},
        Case{
            SPHERE "position_m = [0, 1]",
            "s.toml:3: objects[0].position_m: found [0, 1]; accepted: a list of 3 numbers, each in "
            "[-40000000, 40000000] metres"},
        Case{
            SPHERE "yaw_deg = 1\nlook_at_m = [1, 1, 1]",
            "s.toml:1: objects[0]: more than one attitude; accepted: one of yaw_deg with pitch_deg "
            "and roll_deg, rotation_xyzw, look_at_m, look_at"},
        Case{SPHERE "rotation_xyzw = [0, 0, 0, 0]",
             "s.toml:3: objects[0].rotation_xyzw: found [0, 0, 0, 0]; accepted: a unit quaternion "
             "[x, y, z, w]"},
        Case{SPHERE "scale = -1",
             "s.toml:3: objects[0].scale: found -1; accepted: a number in (0, 1000000]"},
        Case{SPHERE "scale = [1, 0, 1]",
             "s.toml:3: objects[0].scale: found [1, 0, 1]; accepted: a list of 3 numbers, each in "
             "(0, 1000000]"},
        Case{
            SPHERE "name = 'a/b'",
            "s.toml:3: objects[0].name: found \"a/b\"; accepted: 1 to 64 letters, digits, _ and -"},
        Case{SPHERE "name = 'a'\n" SPHERE "name = 'a'",
             "s.toml:6: objects[1].name: found \"a\" a second time; accepted: a name of its own"},
        Case{SPHERE "clip = 'swim'",
             "s.toml:3: objects[0].clip: found \"swim\"; accepted: none, the model has no clips"},
        Case{SPHERE "name = 'ball'\n" SPHERE "on = 'bal'",
             "s.toml:6: objects[1].on: found \"bal\"; accepted: the name of an object or vehicle "
             "(nearest: ball)"},
        Case{SPHERE "name = 'a'\non = 'a'",
             "s.toml:4: objects[0].on: a hangs on itself through on or look_at; accepted: no such "
             "loop, at most 64 steps"},
        Case{SPHERE "name = 'a'\nlook_at = 'a'",
             "s.toml:4: objects[0].look_at: a is at the very place it would be looked at from; "
             "accepted: another"},
        Case{SPHERE "copies = [[1, 2]]",
             "s.toml:3: objects[0].copies: found [1, 2]; accepted: a list of 3, 4 or 5 numbers, "
             "each "
             "in [-40000000, 40000000] metres"},
        Case{SPHERE "copies = []",
             "s.toml:3: objects[0].copies: found []; accepted: one copy or more"},
        Case{
            SPHERE "copies = [[0,0,0]]\nscatter = {area_m = [0,0,1,1]}",
            "s.toml:1: objects[0]: more than one of copies, copies_file, scatter; accepted: one of "
            "them"},
        Case{SPHERE "copies_file = 'c.csv'",
             "s.toml:3: objects[0].copies_file: found \"c.csv\"; accepted: a file; c.csv is none"},
        Case{SPHERE "normal_texture = 'x.png'",
             "s.toml:3: objects[0].normal_texture: found \"x.png\"; accepted: no such key for a "
             "sphere"},
        Case{SPHERE "node = 'x'",
             "s.toml:3: objects[0].node: found \"x\"; accepted: no such key for a sphere"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Scatter, SceneError,
    testing::Values(
        Case{SPHERE "scatter = {count = 3}",
             "s.toml:3: objects[0].scatter.area_m: found nothing; accepted: [x0, z0, x1, z1] in "
             "metres"},
        Case{SPHERE "scatter = {area_m = [1, 0, 0, 1]}",
             "s.toml:3: objects[0].scatter.area_m: found [1, 0, 0, 1]; accepted: [x0, z0, x1, z1] "
             "with x0 < x1 and z0 < z1"},
        Case{SPHERE "scatter = {area_m = [0, 0, 1, 1], count = 0}",
             "s.toml:3: objects[0].scatter.count: found 0; accepted: a whole number from 1 to "
             "65535"},
        Case{
            SPHERE "scatter = {area_m = [0, 0, 1, 1], on = 'sand'}",
            "s.toml:3: objects[0].scatter.on: found \"sand\"; accepted: the name of an object that "
            "is drawn, not scattered"},
        Case{SPHERE "scatter = {area_m = [0, 0, 1, 1], on = 'rig'}\n[[objects]]\nname = 'rig'\n"
                    "lamps = [{}]",
             "s.toml:3: objects[0].scatter.on: found \"rig\"; accepted: the name of an object that "
             "is drawn, not scattered"},
        Case{"[[objects]]\nlamps = [{}]\nradius_m = 3",
             "s.toml:3: objects[0].radius_m: found 3; accepted: no such key for what is not drawn"},
        Case{
            "[[objects]]\nlamps = [{}]\nmaterial = 'steel'",
            "s.toml:3: objects[0].material: found \"steel\"; accepted: no such key for what is not "
            "drawn"},
        Case{SPHERE "scatter = {area_m = [0, 0, 1, 1], aling = 'up'}",
             "s.toml:3: objects[0].scatter.aling: unknown key; nearest known key: align"},
        Case{SPHERE "on = 'x'\nscatter = {area_m = [0, 0, 1, 1]}",
             "s.toml:3: objects[0].on: found \"x\"; accepted: no such key beside scatter"},
        Case{SPHERE "scatter = {area_m = [0, 0, 1, 1], keep_out_m = [[0, 0, 9]]}",
             "s.toml:3: objects[0].scatter: copy 0 of 1 found no place in 256 attempts; accepted: "
             "an "
             "area that the surface covers and keep_out_m leaves free"},
        Case{SPHERE "copies = [[0,0,0]]\n" SPHERE
                    "scatter = {area_m = [0, 0, 1, 1], count = 65535}",
             "s.toml:4: objects[1].name: 65535 copies make 65536 instances in all; accepted: at "
             "most "
             "65535 (16-bit labels)"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Sensor, SceneError,
    testing::Values(
        Case{"[[cameras]]\nwidth = 0",
             "s.toml:2: cameras[0].width: found 0; accepted: a whole number from 1 to 16384"},
        Case{"[[cameras]]\nheight = 16385",
             "s.toml:2: cameras[0].height: found 16385; accepted: a whole number from 1 to 16384"},
        Case{"[[cameras]]\nfov_deg = 170",
             "s.toml:2: cameras[0].fov_deg: found 170; accepted: a number in (1, 170) degrees"},
        Case{"[[cameras]]\nnear_m = 0",
             "s.toml:2: cameras[0].near_m: found 0; accepted: a number in (0, 10] metres"},
        Case{"[[cameras]]\nexposure = 'bright'",
             "s.toml:2: cameras[0].exposure: found \"bright\"; accepted: \"auto\" or a number in "
             "[-30, 30] stops"},
        Case{"[[cameras]]\nstereo_baseline = 0.06",
             "s.toml:2: cameras[0].stereo_baseline: unknown key; nearest known key: "
             "stereo_baseline_m"},
        Case{"[[cameras]]\nlook_at = 'diver'",
             "s.toml:2: cameras[0].look_at: found \"diver\"; accepted: the name of an object or "
             "vehicle"},
        Case{"[[cameras]]\nlook_at_m = [0, 0, 0]",
             "s.toml:2: cameras[0].look_at_m: found [0, 0, 0]; accepted: a point other than "
             "position_m"},
        Case{
            "[[sonars]]\nrange_m = [5, 1]",
            "s.toml:2: sonars[0].range_m: found [5, 1]; accepted: [nearest, farthest], the nearest "
            "smaller than the farthest"},
        Case{
            "[[sonars]]\nrange_m = [0, 20001]",
            "s.toml:2: sonars[0].range_m: found [0, 20001]; accepted: a list of 2 numbers, each in "
            "[0, 20000] metres"},
        Case{"[[sonars]]\nrange_m = 5",
             "s.toml:2: sonars[0].range_m: found 5; accepted: a list of 2 numbers, each in [0, "
             "20000] metres"},
        Case{"[[sonars]]\nazimuth_deg = 0",
             "s.toml:2: sonars[0].azimuth_deg: found 0; accepted: a number in (0, 360] degrees"},
        Case{"[[sonars]]\nelevation_deg = 120.5",
             "s.toml:2: sonars[0].elevation_deg: found 120.5; accepted: a number in (0, 120] "
             "degrees"},
        Case{
            "[[sonars]]\nbins = [500, 500, 0]",
            "s.toml:2: sonars[0].bins: found [500, 500, 0]; accepted: a list of 3 numbers, each in "
            "[1, 8192]"},
        Case{"[[sonars]]\nbins = [500, 500, 2.5]",
             "s.toml:2: sonars[0].bins: found [500, 500, 2.5]; accepted: whole numbers [range, "
             "azimuth, elevation], each in [1, 8192]"},
        Case{"[[sonars]]\nkind = 'side-scan'",
             "s.toml:2: sonars[0].kind: found \"side-scan\"; accepted: one of imaging, profiling, "
             "echosounder, sidescan, mechanical"},
        Case{"[[sonars]]\ngather = 'linear'",
             "s.toml:2: sonars[0].gather: found \"linear\"; accepted: one of plane, nearest, "
             "published"},
        Case{"[[sonars]]\nname = 'a'\n[[cameras]]\nname = 'a'",
             "s.toml:2: sonars[0].name: found \"a\" a second time; accepted: a name of its own"},
        Case{"[[lamps]]\ncone_deg = [40, 20]",
             "s.toml:2: lamps[0].cone_deg: found [40, 20]; accepted: [inner, outer] half angles, "
             "the "
             "inner smaller than the outer"},
        Case{"[[lamps]]\nintensity_cd = -1",
             "s.toml:2: lamps[0].intensity_cd: found -1; accepted: a number in [0, 10000000] "
             "candela"},
        Case{"[[vehicles]]\nshape = 'box'\n[[vehicles.sonars]]\nrate_hz = 0",
             "s.toml:4: vehicles[0].sonars[0].rate_hz: found 0; accepted: a number in (0, 1000] "
             "hertz"},
        Case{"[[vehicles]]\nshape = 'box'\n[[vehicles.sonars]]\non = 'x'",
             "s.toml:4: vehicles[0].sonars[0].on: found \"x\"; accepted: no such key here: it is "
             "mounted on vehicle_0"}),
    name_of);

}  // namespace
}  // namespace neritic::scene
