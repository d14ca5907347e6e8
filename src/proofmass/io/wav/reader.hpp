#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::wav {

/// True if the first bytes are those of RIFF, RIFX, RF64 or BW64 with audio.
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// Opens a WAV file as a recording at its sample rate. Integers are kept as counts; floating-point
/// samples are kept without a unit. If the comment of the file gives channel names and their full
/// scale, as exports of the Axivity software do, accelerations are in g. Sample data whose length
/// was never written, or that are truncated, are read to the file's end.
/// Source: IBM and Microsoft, "Multimedia Programming Interface and Data Specifications 1.0"
/// (1991); EBU Tech 3306 (RF64, 2009); Open Movement, omconvert (comment fields). Errors: corrupt
/// (naming the byte), unsupported (compressed audio), unreadable.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

}  // namespace proofmass::io::wav
