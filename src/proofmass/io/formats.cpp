#include "proofmass/io/formats.hpp"

#include <array>

#include "proofmass/io/csv_reader.hpp"
#include "proofmass/io/foreign_formats.hpp"
#include "proofmass/io/hdf5_reader.hpp"
#include "proofmass/io/mat_reader.hpp"
#include "proofmass/io/npy_reader.hpp"

namespace proofmass::io {
namespace {

bool claims_npy(std::string_view head, std::string_view) {
  return head.starts_with("\x93NUMPY");
}

bool claims_anything(std::string_view, std::string_view) {
  return true;
}

constexpr std::array all_formats = std::to_array<Format>({
    {"npy", claims_npy, read_npy},
    {"MAT", claims_mat, read_mat, true},
    {"HDF5", claims_hdf5, read_hdf5_file, true},
    {"foreign", claims_foreign, refuse_foreign},
    {"CSV", claims_anything, read_csv},
});

}  // namespace

std::span<const Format> formats() {
  return all_formats;
}

}  // namespace proofmass::io
