#include "proofmass/io/nmea/reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/table_reader.hpp"
#include "proofmass/io/text/line_reader.hpp"

namespace proofmass::io::nmea {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double day_s = 86400.0;

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

double number_or_nan(std::string_view text) {
  return number_in(text).value_or(not_a_number);
}

// The XOR of the characters between $ and *; a sentence without a checksum is taken as it is.
bool checksum_holds(std::string_view body, std::string_view after_star) {
  unsigned said = 0, sum = 0;
  if (after_star.size() < 2) return false;
  const auto [end, error] = std::from_chars(after_star.data(), after_star.data() + 2, said, 16);
  if (error != std::errc() || end != after_star.data() + 2) return false;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return sum == said;
}

std::vector<std::string_view> fields_of(std::string_view body) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = body.find(',');
    fields.push_back(body.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    body.remove_prefix(comma + 1);
  }
}

// "hhmmss.ss"
std::optional<double> time_of_day_s(std::string_view text) {
  const std::optional<double> digits = number_in(text);
  if (text.size() < 6 || !digits || *digits < 0.0) return std::nullopt;
  const double hours = std::floor(*digits / 1e4);
  const double minutes = std::floor((*digits - 1e4 * hours) / 100.0);
  const double seconds = *digits - 1e4 * hours - 100.0 * minutes;
  if (hours > 23.0 || minutes > 59.0 || seconds >= 61.0) return std::nullopt;
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

// "ddmm.mmmm" and a hemisphere.
std::optional<double> degrees(std::string_view text, std::string_view hemisphere, double most) {
  const std::optional<double> digits = number_in(text);
  if (!digits || *digits < 0.0 || hemisphere.size() != 1) return std::nullopt;
  const double whole = std::floor(*digits / 100.0);
  const double value = whole + (*digits - 100.0 * whole) / 60.0;
  if (value > most) return std::nullopt;
  const char side = hemisphere.front();
  if (side == 'N' || side == 'E') return value;
  if (side == 'S' || side == 'W') return -value;
  return std::nullopt;
}

bool is_kind(std::string_view sentence, Kind kind) {
  return sentence.size() > 7 && sentence.front() == '$' && sentence[6] == ',' &&
         sentence.substr(3, 3) == (kind == Kind::gga ? "GGA" : "RMC");
}

class Table final : public TableReader {
 public:
  Table(std::unique_ptr<RandomBytes> file, Kind kind)
      : file_(std::move(file)), lines_(*file_, 0, 1), kind_(kind) {
    head_.format = "NMEA";
    head_.headings = {"time (s)", "latitude",   "longitude", "height (m)",
                      "quality",  "satellites", "hdop"};
    head_.columns = head_.headings.size();
    head_.notes.push_back({Severity::info, kind == Kind::gga
                                               ? "positions of the GGA sentences"
                                               : "positions of the RMC sentences, as there is no "
                                                 "GGA among the first"});
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    std::size_t rows = 0;
    while (rows < into[0].size()) {
      const auto more = lines_.next();
      if (!more) return more.error();
      if (!*more) break;
      std::string_view text = lines_.text();
      while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
      if (!is_kind(text, kind_)) continue;
      const std::optional<Fix> fix = parse(text, kind_);
      if (!fix) {
        if (spoilt_++ == 0) first_spoilt_ = lines_.number();
        continue;
      }
      put(*fix, into, rows++);
    }
    return rows;
  }
  [[nodiscard]] std::vector<Note> notes() const override {
    std::vector<Note> notes = file_->notes();
    if (spoilt_ > 0)
      notes.push_back(
          {Severity::warning,
           fmt::format("{} sentences with a wrong checksum or a field that is no number "
                       "are left out, the first in line {}",
                       spoilt_, first_spoilt_)});
    return notes;
  }
  [[nodiscard]] double fraction_read() const override {
    const auto size = static_cast<double>(file_->size());
    return size > 0.0 ? static_cast<double>(lines_.offset()) / size : 1.0;
  }

 private:
  void put(const Fix& fix, std::span<const std::span<double>> into, std::size_t row) {
    double time_s = fix.time_of_day_s + days_ * day_s;
    if (before_s_ && time_s < *before_s_ - 0.5 * day_s) {
      days_ += 1.0;
      time_s += day_s;
    }
    before_s_ = time_s;
    const std::array values{time_s,      fix.latitude_deg, fix.longitude_deg, fix.height_m,
                            fix.quality, fix.satellites,   fix.hdop};
    for (std::size_t c = 0; c < values.size(); ++c) into[c][row] = values[c];
  }

  std::unique_ptr<RandomBytes> file_;
  LineReader lines_;
  Kind kind_;
  TableHead head_;
  double days_ = 0.0;
  std::optional<double> before_s_;
  std::size_t spoilt_ = 0, first_spoilt_ = 0;
};

}  // namespace

std::optional<Fix> parse(std::string_view sentence, Kind kind) {
  if (!is_kind(sentence, kind)) return std::nullopt;
  sentence.remove_prefix(1);
  const std::size_t star = sentence.find('*');
  const std::string_view body = sentence.substr(0, star);
  if (star != std::string_view::npos && !checksum_holds(body, sentence.substr(star + 1)))
    return std::nullopt;
  const std::vector<std::string_view> fields = fields_of(body);
  const bool gga = kind == Kind::gga;
  if (fields.size() < (gga ? 10u : 7u)) return std::nullopt;
  const std::optional<double> time_s = time_of_day_s(fields[1]);
  if (!time_s) return std::nullopt;
  Fix fix{.time_of_day_s = *time_s,
          .latitude_deg = not_a_number,
          .longitude_deg = not_a_number,
          .height_m = gga ? number_or_nan(fields[9]) : not_a_number,
          .quality = gga ? number_in(fields[6]).value_or(0.0) : (fields[2] == "A" ? 1.0 : 0.0),
          .satellites = gga ? number_or_nan(fields[7]) : not_a_number,
          .hdop = gga ? number_or_nan(fields[8]) : not_a_number};
  if (!(fix.quality > 0.0)) return fix;
  const std::size_t at = gga ? 2 : 3;
  const auto latitude = degrees(fields[at], fields[at + 1], 90.0);
  const auto longitude = degrees(fields[at + 2], fields[at + 3], 180.0);
  if (!latitude || !longitude) return std::nullopt;
  fix.latitude_deg = *latitude;
  fix.longitude_deg = *longitude;
  return fix;
}

bool claims(std::string_view head, std::string_view) {
  // One of the first lines, since a log may begin with half a sentence or a header.
  for (int line = 0; line < 20 && !head.empty(); ++line) {
    const std::string_view text = head.substr(0, head.find('\n'));
    if (is_kind(text, Kind::gga) || is_kind(text, Kind::rmc)) return true;
    head.remove_prefix(std::min(head.size(), text.size() + 1));
  }
  return false;
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  const auto head = source->peek(4096);
  if (!head) return head.error();
  const bool gga = head->find("GGA,") != std::string_view::npos;
  auto file = random_bytes_of(std::move(source), options.progress);
  if (!file) return file.error();
  auto reader = recording_reader_of(
      std::make_unique<Table>(std::move(file).value(), gga ? Kind::gga : Kind::rmc), options);
  if (!reader) return reader.error();
  return only_table(std::move(reader).value());
}

}  // namespace proofmass::io::nmea
