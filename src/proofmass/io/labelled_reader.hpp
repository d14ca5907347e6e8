#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

/// A reader whose recording has these labels too: of a format that keeps them beside its rows.
/// Labels that cannot be those of so many rows (out of order, beyond the end, without a text) are
/// left out, all of them.
[[nodiscard]] std::unique_ptr<RecordingReader> labelled(std::unique_ptr<RecordingReader> reader,
                                                        std::vector<Label> labels,
                                                        std::string channel,
                                                        std::uint64_t rows);

}  // namespace proofmass::io
