#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::nmea {

/// True if the first lines are sentences of NMEA 0183 with positions: "$GPGGA,…", "$GNRMC,…".
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// Opens a log of NMEA 0183 sentences as a recording of position fixes with the channels latitude
/// and longitude in degrees, height in m, quality (0: no fix), satellites and hdop; time is the
/// UTC time of day, continued over midnight. Rows are the GGA sentences, or the RMC sentences of a
/// log without GGA (height, satellites and hdop are then NaN, and quality is 1 for a valid fix).
/// A sentence whose checksum is wrong or whose fields are not numbers is left out, which a note
/// says.
/// Source: NMEA 0183 (1983 to 2018), as described in E. S. Raymond, "NMEA Revealed" (2023).
/// Errors: corrupt (a line of more than 1 MiB), unreadable.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

/// One position of a GGA or RMC sentence. A position without a fix has NaN coordinates.
struct Fix {
  double time_of_day_s = 0.0;
  double latitude_deg = 0.0, longitude_deg = 0.0, height_m = 0.0;
  double quality = 0.0, satellites = 0.0, hdop = 0.0;
};

enum class Kind { gga, rmc };

/// The fix of a sentence of that kind; nullopt if it is of another, its checksum is wrong, or a
/// field is not a number.
[[nodiscard]] std::optional<Fix> parse(std::string_view sentence, Kind kind);

}  // namespace proofmass::io::nmea
