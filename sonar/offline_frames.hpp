// Folders of images as frames: which files there are, and which belong together.
//
// A frame's name is its file's path, without folder parts, prefix and suffix that all files of its
// group share, and without its extension: depth_0001.png and normal_0001.exr, 0001_depth.npy and
// 0001_normals.npy, or frame_0001/camera/depth.npy and .../normals.npy are all frame 0001. A shared
// part ends at a separator (/ _ - . or a space) or between a letter and a digit, so that no
// number is cut in two: depth_0010 and depth_0011 are 0010 and 0011. A group of one file is named
// by the longest run of digits in its stem, or all of it. Where a group has files of the same stems
// as the leading group, these count. Any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::sonar {

// Whether a flag's value stands for more than one file: a folder, or a pattern with * or ? (or
// [...]) in it that is not itself the name of a file.
bool names_many(const std::string& pattern);

// Files sorted by name: from a folder (not those below it) the visible files with this ending
// ("png", any case, no dot), or all that match a pattern. kBadInput if there is none.
// unusable: gets those of these names that cannot be followed, with the reason: links that lead
// nowhere or in a loop.
struct UnusableFile {
  std::filesystem::path path;
  std::string reason;
};
Result<std::vector<std::filesystem::path>> list_files(const std::string& pattern,
                                                      std::span<const char* const> extensions,
                                                      std::vector<UnusableFile>& unusable);

// The frames' names, in the order of the files: fit for a folder's, never empty.
std::vector<std::string> frame_names(std::span<const std::filesystem::path> files);

// files[0] leads. One frame a leading file, in its order; paths[g] belongs to files[g], empty where
// that group is empty or has no such file. kBadInput where two files of a group are one frame.
struct FrameFiles {
  std::string name;
  std::vector<std::filesystem::path> paths;
};
Result<std::vector<FrameFiles>> pair_frames(
    std::span<const std::vector<std::filesystem::path>> files);

}  // namespace neritic::sonar
