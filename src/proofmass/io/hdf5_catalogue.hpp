#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A dataset of numbers in an HDF5 file.
struct Hdf5Dataset {
  std::string path;     ///< for people: "imu/acc"; of a MAT file "imu.acc", "runs(2).acc"
  std::string address;  ///< for the library: "/imu/acc", "/#refs#/b"
  std::string type;     ///< "float64", "int16", "bool"; of a MAT file the class, "double"
  std::vector<std::uint64_t> shape{};  ///< slowest first; empty for a single number
  std::size_t group_length = 0;        ///< of the path up to the group it is in
  bool is_complex = false;
  /// Rows of named fields: the fields that are numbers are the last dimension, and are named by an
  /// attribute "columns".
  bool is_compound = false;
  std::optional<double> figure{};  ///< the value of a single number
};

/// An attribute: what a file says about a dataset, a group, or itself.
struct Hdf5Attribute {
  std::string owner;  ///< path of the object; empty for the file
  std::string name;
  std::vector<std::string> texts{};
  std::optional<double> figure{};
  std::optional<std::int64_t> integer{};  ///< the figure again, where it is an integer: exact
};

/// What is in an HDF5 file.
struct Hdf5Catalogue {
  std::vector<Hdf5Dataset> datasets;
  std::vector<Hdf5Attribute> attributes;
  std::vector<std::string> skipped;  ///< "title (text)", "f (link)"
  std::vector<Label> runs{};         ///< of samples that have a label; not checked
  std::string run_channel{};         ///< Recording::label_channel
  bool is_cut = false;               ///< there is more than is listed
};

/// More objects than anybody tells apart: what is beyond is not listed.
inline constexpr std::size_t most_hdf5_objects = 4096;
inline constexpr std::size_t most_hdf5_runs = std::size_t{1} << 16;
inline constexpr std::size_t most_catalogue_bytes = std::size_t{8} << 20;

/// A catalogue as bytes and back. decode() believes nothing: lengths are held to the bytes there
/// are, names (but not addresses) come back as printable text, shapes that no file can have are
/// refused. Errors of decode: corrupt.
[[nodiscard]] std::string encode(const Hdf5Catalogue& catalogue);
[[nodiscard]] Result<Hdf5Catalogue> decode(std::string_view bytes);

}  // namespace proofmass::io
