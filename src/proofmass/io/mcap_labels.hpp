#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

/// The attachment that holds a recording's labels: a table of text, "first,last,NAME", with the
/// samples from 0 and NAME the column of words that they come from.
inline constexpr std::string_view mcap_labels_name = "labels.csv";

[[nodiscard]] std::string labels_table(const Recording& recording);
/// Gives the labels of such a table to a recording of `samples`; those beyond it, or out of order,
/// are left out.
void add_labels(std::string_view table, std::size_t samples, Recording& recording);

/// The same recording with the labels that `table` holds once all rows are read.
[[nodiscard]] std::unique_ptr<RecordingReader> with_labels(std::unique_ptr<RecordingReader> reader,
                                                           std::shared_ptr<std::string> table);

}  // namespace proofmass::io
