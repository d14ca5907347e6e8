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

namespace proofmass::io::hdf5 {

/// A numeric dataset in an HDF5 file.
struct Dataset {
  std::string path;     ///< for display: "imu/acc"; for a MAT file "imu.acc", "runs(2).acc"
  std::string address;  ///< for the library: "/imu/acc", "/#refs#/b"
  std::string type;     ///< "float64", "int16", "bool"; for a MAT file the class, "double"
  std::vector<std::uint64_t> shape{};  ///< slowest dimension first; empty for a scalar
  std::size_t group_length = 0;        ///< length of the path of its group
  bool is_complex = false;
  /// Rows of named fields: the numeric fields are the last dimension, and are named by an attribute
  /// "columns".
  bool is_compound = false;
  std::optional<double> figure{};  ///< the value of a scalar
};

/// An attribute of a dataset, a group, or the file.
struct Attribute {
  std::string owner;  ///< path of the object; empty for the file
  std::string name;
  std::vector<std::string> texts{};
  std::optional<double> figure{};
  std::optional<std::int64_t> integer{};  ///< the exact value, if it is an integer
};

/// Contents of an HDF5 file.
struct Catalogue {
  std::vector<Dataset> datasets;
  std::vector<Attribute> attributes;
  std::vector<std::string> skipped;  ///< "title (text)", "f (link)"
  std::vector<Label> runs{};         ///< runs of labelled samples; not checked
  std::string run_channel{};         ///< Recording::label_channel
  bool is_cut = false;               ///< the list is incomplete
};

/// Maximum number of listed objects; a user would not distinguish more.
inline constexpr std::size_t most_objects = 4096;
inline constexpr std::size_t most_runs = std::size_t{1} << 16;
inline constexpr std::size_t most_catalogue_bytes = std::size_t{8} << 20;

/// Serialises a catalogue. decode() trusts nothing: lengths are checked against the available
/// bytes, names (but not addresses) are made printable, impossible shapes are rejected. Errors of
/// decode: corrupt.
[[nodiscard]] std::string encode(const Catalogue& catalogue);
[[nodiscard]] Result<Catalogue> decode(std::string_view bytes);

}  // namespace proofmass::io::hdf5
