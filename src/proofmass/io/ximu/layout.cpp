#include "proofmass/io/layouts/layout.hpp"

#include <array>
#include <chrono>
#include <fmt/format.h>

#include "proofmass/io/archive/names.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/ximu/rates.hpp"
#include "proofmass/io/ximu/reader.hpp"

namespace proofmass::io::ximu {
namespace {

/// A data file by the end of its name, and the register with its rate.
struct DataFile {
  std::string_view ending;
  std::string_view rate_register;
};
// The manufacturer's program changed some of the names.
constexpr std::array data_files = std::to_array<DataFile>({
    {"_CalInertialAndMag", "InertialAndMagneticDataRate"},
    {"_CalInertialMagnetic", "InertialAndMagneticDataRate"},
    {"_RawInertialAndMag", "InertialAndMagneticDataRate"},
    {"_RawInertialMagnetic", "InertialAndMagneticDataRate"},
    {"_CalBattAndTherm", "BatteryAndThermometerDataRate"},
    {"_CalBattTherm", "BatteryAndThermometerDataRate"},
    {"_RawBattAndTherm", "BatteryAndThermometerDataRate"},
    {"_RawBattTherm", "BatteryAndThermometerDataRate"},
    {"_Quaternion", "QuaternionDataRate"},
    {"_RotationMatrix", "QuaternionDataRate"},
    {"_EulerAngles", "QuaternionDataRate"},
});

/// An entry of the session `prefix`, by the end of its name; the number of entries if there is
/// none.
std::size_t find_entry(const Archive& archive, const std::string& name) {
  const auto entries = archive.entries();
  for (std::size_t e = 0; e < entries.size(); ++e)
    if (lower(without_endings(entries[e].name)) == lower(name)) return e;
  return entries.size();
}

/// The value of a register by name; nullopt if the file does not have it.
std::optional<std::uint64_t> register_in(std::string_view text, std::string_view name) {
  for (const std::string_view line : lines_of(text)) {
    if (field_of(line, ',', 4) != name) continue;
    const Cell value = read_cell(field_of(line, ',', 2), '.');
    if (value.kind == CellKind::number && value.value >= 0.0 && value.value < 65'536.0)
      return static_cast<std::uint64_t>(value.value);
  }
  return std::nullopt;
}

/// A packet of date and time.
struct DatedPacket {
  std::uint64_t number = 0;
  double time_s = 0.0;  ///< since 1970
};

std::vector<DatedPacket> dates_in(std::string_view text) {
  std::vector<DatedPacket> dates;
  for (const std::string_view line : lines_of(text)) {
    std::array<double, 7> part{};
    bool whole = true;
    for (std::size_t c = 0; c < part.size(); ++c) {
      const Cell cell = read_cell(field_of(line, ',', c), '.');
      whole = whole && cell.kind == CellKind::number && cell.value >= 0.0 && cell.value < 1e15;
      part[c] = whole ? cell.value : 0.0;
    }
    if (!whole || part[1] > 9999.0 || part[2] > 12.0 || part[3] > 31.0) continue;
    const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(part[1])),
                                           std::chrono::month(static_cast<unsigned>(part[2])),
                                           std::chrono::day(static_cast<unsigned>(part[3]))};
    if (!date.ok()) continue;
    const auto days = std::chrono::sys_days(date).time_since_epoch().count();
    dates.push_back(
        {static_cast<std::uint64_t>(part[0]),
         static_cast<double>(days) * 86'400.0 + part[4] * 3'600.0 + part[5] * 60.0 + part[6]});
  }
  return dates;
}

/// Number of rows of a table whose packet number, the first column, is in [first, last).
std::uint64_t rows_between(Archive& archive,
                           std::size_t entry,
                           std::uint64_t first,
                           std::uint64_t last) {
  const auto source = archive.open(entry);
  if (!source) return 0;
  std::uint64_t rows = 0;
  std::uint64_t number = 0;
  bool in_number = true;
  std::vector<char> buffer(std::size_t{64} << 10);
  constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;  // a day at the highest rate
  for (std::uint64_t taken = 0; taken < most_bytes;) {
    const auto count = (*source)->read(buffer);
    if (!count || *count == 0) return rows;
    taken += *count;
    for (const char c : std::span(buffer).first(*count)) {
      if (c == '\n') {
        number = 0;
        in_number = true;
      } else if (in_number && c >= '0' && c <= '9' && number < std::uint64_t{1} << 50) {
        number = 10 * number + static_cast<std::uint64_t>(c - '0');
      } else if (in_number) {
        in_number = false;
        if (c == ',' && number >= first && number < last) ++rows;
      }
    }
  }
  return 0;
}

/// The rate counted between the first and last date and time of the session; adds a note on its
/// origin.
std::optional<double> counted_rate_hz(Archive& archive,
                                      std::size_t entry,
                                      const std::string& session,
                                      std::string& how) {
  const std::size_t clock = find_entry(archive, session + "_DateTime");
  if (clock == archive.entries().size()) return std::nullopt;
  const auto dates = dates_in(text_of(archive, clock));
  if (dates.size() < 2) return std::nullopt;
  const double seconds = dates.back().time_s - dates.front().time_s;
  const std::uint64_t rows =
      rows_between(archive, entry, dates.front().number, dates.back().number);
  how = fmt::format("{} rows in the {} s of {}", rows, seconds, archive.entries()[clock].name);
  return rate_counted(rows, seconds);
}

/// The rate of the card's own file beside the CSV made from it.
std::optional<double> card_rate_hz(Archive& archive, const std::string& session, std::string& how) {
  const auto entries = archive.entries();
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (lower(entries[e].name) != lower(session + ".bin")) continue;
    auto source = archive.open(e);
    if (!source) return std::nullopt;
    auto bytes = random_bytes_of(std::move(source).value(), {});
    if (!bytes) return std::nullopt;
    how = "the date and time packets of " + entries[e].name;
    return inertial_rate_hz(**bytes);
  }
  return std::nullopt;
}

MemberHint hint_of(Archive& archive,
                   std::size_t entry,
                   const std::string& session,
                   const DataFile& kind) {
  MemberHint hint;
  hint.left_out = "Packet number";
  std::string how;
  const std::size_t registers = find_entry(archive, session + "_Registers");
  if (registers < archive.entries().size()) {
    if (const auto value = register_in(text_of(archive, registers), kind.rate_register))
      hint.rate_hz = rate_hz_of(*value);
    how = fmt::format("{} of {}", kind.rate_register, archive.entries()[registers].name);
  }
  if (!hint.rate_hz) hint.rate_hz = counted_rate_hz(archive, entry, session, how);
  if (!hint.rate_hz && kind.ending.starts_with("_CalInertial"))
    hint.rate_hz = card_rate_hz(archive, session, how);
  hint.notes.push_back({Severity::info,
                        "x-IMU: packet numbers, which count packets of all kinds, "
                        "are not times and are omitted"});
  if (hint.rate_hz)
    hint.notes.push_back({Severity::info, fmt::format("rate {} Hz by {}", *hint.rate_hz, how)});
  else
    hint.notes.push_back({Severity::info, "no file beside it states its rate", {Advice{"rate"}}});
  return hint;
}

}  // namespace

void read_layout(Archive& archive, ArchiveLayout& layout) {
  const auto entries = archive.entries();
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const std::string stem = without_endings(entries[e].name);
    for (const std::string_view ending : {"_Registers", "_Commands", "_DateTime", "_Errors"})
      if (stem.ends_with(ending) && text_of(archive, e).starts_with("Packet number,"))
        layout[e].is_recording = false;
    for (const DataFile& kind : data_files) {
      if (!stem.ends_with(kind.ending) || !text_of(archive, e).starts_with("Packet number,"))
        continue;
      const std::string session = stem.substr(0, stem.size() - kind.ending.size());
      layout[e] = hint_of(archive, e, session, kind);
    }
  }
}

}  // namespace proofmass::io::ximu
