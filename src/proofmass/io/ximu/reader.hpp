#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::ximu {

/// True if the first bytes are packets of x-io's x-IMU with valid checksums: the .BIN of its card.
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// One table for each type of packet with numbers, named as in the manufacturer's CSV:
/// "CalInertialAndMag", … The rate is counted between the packets of date and time. Damaged packets
/// are reported and skipped. Errors: too_few_samples (no packet with numbers).
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

/// The rate of the calibrated inertial packets, for the CSV made from them; nullopt if it cannot be
/// determined.
[[nodiscard]] std::optional<double> inertial_rate_hz(const RandomBytes& bytes);

}  // namespace proofmass::io::ximu
