#include "proofmass/io/archive/names.hpp"

#include <algorithm>
#include <array>

#include "proofmass/io/names.hpp"

namespace proofmass::io {
namespace {

std::string_view without_ending(std::string_view path, bool (*is_meant)(std::string_view)) {
  const std::string_view file = file_part(path);
  const auto dot = file.rfind('.');
  if (dot == std::string_view::npos || dot == 0 || !is_meant(file.substr(dot + 1))) return path;
  return path.substr(0, path.size() - (file.size() - dot));
}

bool is_compression(std::string_view ending) {
  constexpr std::array<std::string_view, 3> compressions{"gz", "xz", "zst"};
  return is_one_of(ending, compressions);
}

bool is_format(std::string_view ending) {
  constexpr std::array<std::string_view, 19> formats{
      "csv", "tsv", "txt", "dat", "asc",  "log",  "mat",     "h5",  "hdf5", "npy",
      "npz", "bin", "wav", "lvm", "tdms", "mcap", "parquet", "tab", "prn"};
  return is_one_of(ending, formats);
}

}  // namespace

std::string without_endings(std::string_view path) {
  return std::string(without_ending(without_ending(path, is_compression), is_format));
}

}  // namespace proofmass::io
