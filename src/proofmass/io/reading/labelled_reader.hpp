#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io {

/// A reader with labels added to its recording, for formats that store them beside the rows. If
/// they are invalid for the number of rows (out of order, beyond the end, without a text), all of
/// them are dropped.
[[nodiscard]] std::unique_ptr<RecordingReader> labelled(std::unique_ptr<RecordingReader> reader,
                                                        std::vector<Label> labels,
                                                        std::string channel,
                                                        std::uint64_t rows);

}  // namespace proofmass::io
