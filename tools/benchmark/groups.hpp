// The groups of benchmarks, one file each. Each leaves its results, ratios and aims in the suite.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "engine/gpu/device.hpp"
#include "testbed/sensors/session.hpp"
#include "tools/benchmark/suite.hpp"

namespace neritic::bench {

// The last three need no device.
inline constexpr std::string_view kGroups[] = {
    "sonar_binning", "sonar_frame", "sonar_terms", "camera_frame", "picture_terms", "sweep",
    "deco",          "start",       "threads",     "physics",      "contacts",      "diver"};
inline constexpr std::size_t kGroupsWithoutDevice = 3;

Status bench_physics(Suite& suite);                             // vehicles, hand-off of states
Status bench_physics_fleet(Suite& suite);                       // a scene of 1000 vehicles
Status bench_contacts(Suite& suite);                            // contacts against triangles
Status bench_diver(Suite& suite);                               // a swimming diver
Status bench_sonar_binning(Suite& suite, gpu::Device& device);  // the gather against the volume
Status bench_sonar_frame(Suite& suite, gpu::Device& device);    // whole frames, one sonar and ten
Status bench_sonar_terms(Suite& suite, gpu::Device& device);    // a frame with each term named
Status bench_camera_frame(Suite& suite, gpu::Device& device);   // pictures, many instances
Status bench_picture_terms(Suite& suite, gpu::Device& device);  // each term of a picture
Status bench_sweeps(Suite& suite, gpu::Device& device);         // cost against sizes
Status bench_deco(Suite& suite);  // plans, views, tissues of many divers; no GPU
Status bench_start(Suite& suite, gpu::Device& device);               // process start to picture
Status bench_threads(Suite& suite, const std::string& device_name);  // same bits on 1 and 2 threads

// A scene of assets/scenes in a session, changed first.
Result<std::unique_ptr<testbed::Session>> open_scene(
    const Suite& suite, gpu::Device& device, const std::string& file,
    const std::function<void(scene::Scene&)>& change = {});

std::string hash_of(const sonar::SonarImage& image);
std::string hash_of(const testbed::FrameResult& result);
std::map<std::string, double> parts_of(const std::vector<gpu::PassTime>& passes);

// Runs of one frame as a contender, by the loop that `render` runs; the session must outlive it.
// Wall time: evaluate, draw lists, graph, record, run, arrays at the host.
Contender frames_of(const std::string& name, testbed::Session& session,
                    const testbed::FrameRequest& request);

// Depth and normals of a wavy wall 2 to 4 m away that fills a wedge: every pixel counts.
sonar::SonarInput relief_input(const sonar::BeamGrid& grid, std::uint32_t width,
                               std::uint32_t height);

}  // namespace neritic::bench
