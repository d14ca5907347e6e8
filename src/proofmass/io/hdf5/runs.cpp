#include "proofmass/io/hdf5/runs.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "proofmass/io/hdf5/attributes.hpp"
#include "proofmass/io/hdf5/handle.hpp"
#include "proofmass/io/hdf5/text.hpp"

namespace proofmass::io::hdf5 {
namespace {

constexpr const char* mark = "label_channel";

struct Row {
  std::uint64_t first;
  std::uint64_t last;
  const char* text;
};

Handle row_type() {
  const Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(text, H5T_VARIABLE);
  H5Tset_cset(text, H5T_CSET_UTF8);
  Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Row)), H5Tclose);
  H5Tinsert(type, "first", HOFFSET(Row, first), H5T_NATIVE_UINT64);
  H5Tinsert(type, "last", HOFFSET(Row, last), H5T_NATIVE_UINT64);
  H5Tinsert(type, "text", HOFFSET(Row, text), text);
  return type;
}

}  // namespace

bool put_runs(hid_t file, const Recording& recording) {
  if (recording.labels.empty()) return true;
  std::vector<Row> rows;
  rows.reserve(recording.labels.size());
  for (const Label& label : recording.labels)
    rows.push_back({label.first, label.last, label.text.c_str()});
  const Handle type = row_type();
  const hsize_t count = rows.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle dataset(
      H5Dcreate2(file, "labels", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  return dataset && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0 &&
         put_text(dataset, mark, recording.label_channel);
}

bool holds_runs(hid_t dataset) {
  return has_attribute(dataset, mark);
}

bool read_runs(hid_t dataset, Catalogue& catalogue) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count < 1 || static_cast<std::uint64_t>(count) > most_runs) return false;
  const Handle type = row_type();
  std::vector<Row> rows(static_cast<std::size_t>(count), Row{0, 0, nullptr});
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0) return false;
  for (const Row& row : rows)
    catalogue.runs.push_back({row.text == nullptr ? "" : row.text, row.first, row.last});
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, rows.data());
  catalogue.run_channel = text_attribute(dataset, mark);
  return true;
}

}  // namespace proofmass::io::hdf5
