#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/hdf5/catalogue.hpp"
#include "proofmass/io/matlab/mat_choice.hpp"

// Metadata of an HDF5 file: names, attributes and texts.
namespace proofmass::io::hdf5 {

/// Headings with units for all columns of the tables, `values` being their columns.
///
/// - A vector has the name of its dataset; columns of a matrix are "acc_x acc_y acc_z", quaternions
///   "_w _x _y _z", others numbered; or as listed in an attribute such as `columns`; `channel_name`
///   is the exact name.
/// - A name that is uninformative or not unique is prefixed with its group's.
/// - Units: an attribute `units`, else one in the name, else the one given for the name in a text
///   in the file ("`acc` in m/s²"), with a note.
/// - The first column is the time if it increases, unless there are three, or is_timed is set
///   because the file gives the time or the rate otherwise.
[[nodiscard]] std::vector<std::string> headings_of(
    const Catalogue& catalogue,
    const std::vector<matlab::Table>& tables,
    const std::vector<std::vector<std::vector<double>>>& values,
    bool is_timed,
    std::vector<Note>& notes);

/// Names of columns that differ only by number: "acc_x acc_y acc_z", "T 1", "T 2".
[[nodiscard]] std::vector<std::string> names_by_place(const std::string& stem, std::size_t width);

/// The time of the first sample in nanoseconds, from an attribute `start_time_ns` of a dataset or
/// the nearest group around it.
[[nodiscard]] std::optional<std::int64_t> start_ns_of(const Catalogue& catalogue,
                                                      std::string_view path);

/// The rate from an attribute or a scalar of such a name (`fs`, `sampling_rate`; `dt` in seconds),
/// of the first table, or the nearest group around it.
[[nodiscard]] std::optional<double> rate_hz_of(const Catalogue& catalogue,
                                               const std::vector<matlab::Table>& tables,
                                               std::vector<Note>& notes);

/// Notes on further metadata for the user: texts about the whole file, scale factors that were not
/// applied.
void note_texts(const Catalogue& catalogue,
                const std::vector<matlab::Table>& tables,
                std::vector<Note>& notes);

}  // namespace proofmass::io::hdf5
