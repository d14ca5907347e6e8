#pragma once

#include <hdf5.h>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/hdf5_catalogue.hpp"

namespace proofmass::io {

/// Writes a recording's labels, if it has any, as a dataset "labels" of rows (first, last, text):
/// the samples of a run, the last belonging to it. False where they cannot be written.
[[nodiscard]] bool put_runs(hid_t file, const Recording& recording);

/// Whether a dataset is what put_runs() writes.
[[nodiscard]] bool holds_runs(hid_t dataset);
/// Reads them into the catalogue; false where they cannot be read, or are too many.
[[nodiscard]] bool read_runs(hid_t dataset, Hdf5Catalogue& catalogue);

}  // namespace proofmass::io
