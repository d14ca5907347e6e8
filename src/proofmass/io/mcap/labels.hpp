#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io::mcap {

/// The attachment with a recording's labels: a text table, "first,last,NAME", with samples from 0
/// and NAME the text column of their origin.
inline constexpr std::string_view labels_name = "labels.csv";

[[nodiscard]] std::string labels_table(const Recording& recording);
/// Adds the labels of such a table to a recording of `samples`; labels beyond the end, or out of
/// order, are dropped.
void add_labels(std::string_view table, std::size_t samples, Recording& recording);

/// The same recording with the labels of `table` once all rows are read.
[[nodiscard]] std::unique_ptr<RecordingReader> with_labels(std::unique_ptr<RecordingReader> reader,
                                                           std::shared_ptr<std::string> table);

}  // namespace proofmass::io::mcap
