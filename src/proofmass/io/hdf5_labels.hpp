#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/hdf5_catalogue.hpp"
#include "proofmass/io/mat_choice.hpp"

// What an HDF5 file says about its figures: in names, attributes and texts.
namespace proofmass::io {

/// Headings with units for all columns of the tables, `values` being their columns. A vector is
/// called as its dataset, columns of a matrix "acc_x acc_y acc_z", quaternions "_w _x _y _z",
/// others by number; or as an attribute such as `columns` lists them; `channel_name` is its name to
/// the letter. A name that says nothing or that another has too takes its group's before it. Units:
/// an attribute `units`, else one in the name, else what a text in the file says of the name
/// ("`acc` in m/s²"), which a note tells. The first column is the time if it ascends, unless there
/// are three, or is_timed says that the file has told the time or the rate otherwise.
[[nodiscard]] std::vector<std::string> hdf5_headings(
    const Hdf5Catalogue& catalogue,
    const std::vector<MatTable>& tables,
    const std::vector<std::vector<std::vector<double>>>& values,
    bool is_timed,
    std::vector<Note>& notes);

/// Names of columns that only their number tells apart: "acc_x acc_y acc_z", "T 1", "T 2".
[[nodiscard]] std::vector<std::string> names_by_place(const std::string& stem, std::size_t width);

/// The time of the first sample in nanoseconds, by an attribute `start_time_ns` of a dataset or the
/// nearest group around it.
[[nodiscard]] std::optional<std::int64_t> hdf5_start_ns(const Hdf5Catalogue& catalogue,
                                                        std::string_view path);

/// The rate by an attribute or a single number called so (`fs`, `sampling_rate`; `dt` in seconds),
/// of the first table, or the nearest group around it.
[[nodiscard]] std::optional<double> hdf5_rate_hz(const Hdf5Catalogue& catalogue,
                                                 const std::vector<MatTable>& tables,
                                                 std::vector<Note>& notes);

/// What else the file says that a person should know: the texts about the file as a whole, factors
/// that were not applied.
void tell_texts(const Hdf5Catalogue& catalogue,
                const std::vector<MatTable>& tables,
                std::vector<Note>& notes);

}  // namespace proofmass::io
