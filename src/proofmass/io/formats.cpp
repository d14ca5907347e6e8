#include "proofmass/io/formats.hpp"

#include <algorithm>
#include <array>

#include "proofmass/io/csv/reader.hpp"
#include "proofmass/io/foreign_formats.hpp"
#include "proofmass/io/hdf5/reader.hpp"
#include "proofmass/io/layouts/zip_reader.hpp"
#include "proofmass/io/lvm/reader.hpp"
#include "proofmass/io/matlab/mat_reader.hpp"
#include "proofmass/io/mcap/reader.hpp"
#include "proofmass/io/nmea/reader.hpp"
#include "proofmass/io/numpy/npy_reader.hpp"
#include "proofmass/io/parquet/reader.hpp"
#include "proofmass/io/tdms/reader.hpp"
#include "proofmass/io/wav/reader.hpp"
#include "proofmass/io/ximu/reader.hpp"

namespace proofmass::io {
namespace {

bool claims_anything(std::string_view, std::string_view) {
  return true;
}

constexpr std::array all_formats = std::to_array<Format>({
    {"npy", claims_npy, open_npy},
    {"MAT", matlab::claims, matlab::open, true},
    {"HDF5", hdf5::claims, hdf5::open, true},
    {"TDMS", tdms::claims, tdms::open},
    {"LVM", lvm::claims, lvm::open},
    {"MCAP", mcap::claims, mcap::open},
    {"WAV", wav::claims, wav::open},
    {"x-IMU", ximu::claims, ximu::open},
    {"NMEA", nmea::claims, nmea::open},
    {"zip", claims_zip, open_zip_tables, true},
    {"Parquet", parquet::claims, parquet::open},
    {"foreign", claims_foreign, refuse_foreign},
    {"CSV", claims_anything, open_csv},
});

}  // namespace

std::span<const Format> formats() {
  return all_formats;
}

Result<std::unique_ptr<TableFile>> open_tables(std::unique_ptr<ByteSource> bytes,
                                               const std::string& name,
                                               const ReadOptions& options) {
  auto source = unwrap(std::move(bytes));
  if (!source) return source.error();
  std::unique_ptr<PeekSource> opened = std::move(source).value();
  const auto head = opened->peek(4096);
  if (!head) return head.error();
  const auto all = formats();
  const auto format =
      std::ranges::find_if(all, [&](const Format& f) { return f.claims(*head, name); });
  auto file = format->open(std::move(opened), options);
  if (!file) return file.error();
  const auto tables = (*file)->tables();
  const bool is_nameless = tables.size() == 1 && tables.front().name.empty();
  if (!options.variables.empty() && !format->has_variables && is_nameless)
    return Error{Errc::invalid_argument,
                 "has one table only and nothing to choose from: a variable is chosen in "
                 "files of several, as MAT, HDF5, TDMS and MCAP have"};
  return file;
}

}  // namespace proofmass::io
