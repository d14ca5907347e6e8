#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/random_bytes.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// Whether the first bytes are packets of x-io's x-IMU with good checksums: the .BIN of its card.
[[nodiscard]] bool claims_ximu(std::string_view head, std::string_view file_name);

/// A table for each kind of packet that holds figures, called as in the maker's CSV:
/// "CalInertialAndMag", … The rate is counted between the packets of date and time. Packets that
/// are damaged are told and left out. Errors: too_few_samples (no packet of figures).
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_ximu(std::unique_ptr<PeekSource> source,
                                                           const ReadOptions& options);

/// The rate of the calibrated inertial packets, for the CSV that was made of them; nullopt if it
/// cannot be told.
[[nodiscard]] std::optional<double> ximu_inertial_rate_hz(const RandomBytes& bytes);

}  // namespace proofmass::io
