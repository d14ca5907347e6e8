#pragma once

#include <hdf5.h>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/hdf5/catalogue.hpp"

namespace proofmass::io::hdf5 {

/// Writes a recording's labels, if any, as a dataset "labels" of rows (first, last, text): the
/// samples of a run, the last inclusive. False if they cannot be written.
[[nodiscard]] bool put_runs(hid_t file, const Recording& recording);

/// True if a dataset was written by put_runs().
[[nodiscard]] bool holds_runs(hid_t dataset);
/// Reads them into the catalogue; false if they cannot be read, or are too many.
[[nodiscard]] bool read_runs(hid_t dataset, Catalogue& catalogue);

}  // namespace proofmass::io::hdf5
