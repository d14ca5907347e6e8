#pragma once

#include <string_view>

namespace proofmass::io::hdf5 {

/// The group of an object: "imu" of "imu/acc"; empty for the file itself.
[[nodiscard]] inline std::string_view group_of(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view{} : path.substr(0, slash);
}

/// Its own name: "acc" of "imu/acc".
[[nodiscard]] inline std::string_view leaf_of(std::string_view path) {
  return path.substr(path.rfind('/') + 1);  // npos + 1 is 0
}

/// True if a path is a group or lies within it.
[[nodiscard]] inline bool is_within(std::string_view path, std::string_view group) {
  return group.empty() || path == group || (path.starts_with(group) && path[group.size()] == '/');
}

}  // namespace proofmass::io::hdf5
