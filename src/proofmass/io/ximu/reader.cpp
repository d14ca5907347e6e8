#include "proofmass/io/ximu/reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>

#include "proofmass/io/ximu/packets.hpp"
#include "proofmass/io/ximu/rates.hpp"

namespace proofmass::io::ximu {
namespace {

/// A column of a packet type; its raw value is in units of `1 / 2^bits`.
struct Column {
  std::string_view heading;
  int bits = 0;
};
struct Kind {
  std::uint8_t header = 0;
  std::string_view name;
  std::span<const Column> columns;
};

constexpr std::array raw_battery = std::to_array<Column>({{"Battery", 0}, {"Thermometer", 0}});
constexpr std::array battery =
    std::to_array<Column>({{"Battery voltage (V)", 12}, {"Thermometer (degC)", 8}});
constexpr std::array raw_inertial = std::to_array<Column>({{"Gyroscope X (counts)", 0},
                                                           {"Gyroscope Y (counts)", 0},
                                                           {"Gyroscope Z (counts)", 0},
                                                           {"Accelerometer X (counts)", 0},
                                                           {"Accelerometer Y (counts)", 0},
                                                           {"Accelerometer Z (counts)", 0},
                                                           {"Magnetometer X (counts)", 0},
                                                           {"Magnetometer Y (counts)", 0},
                                                           {"Magnetometer Z (counts)", 0}});
constexpr std::array inertial = std::to_array<Column>({{"Gyroscope X (deg/s)", 4},
                                                       {"Gyroscope Y (deg/s)", 4},
                                                       {"Gyroscope Z (deg/s)", 4},
                                                       {"Accelerometer X (g)", 11},
                                                       {"Accelerometer Y (g)", 11},
                                                       {"Accelerometer Z (g)", 11},
                                                       {"Magnetometer X (G)", 11},
                                                       {"Magnetometer Y (G)", 11},
                                                       {"Magnetometer Z (G)", 11}});
constexpr std::array quaternion = std::to_array<Column>(
    {{"Element 0", 15}, {"Element 1", 15}, {"Element 2", 15}, {"Element 3", 15}});
// Source: x-io Technologies, x-IMU User Manual 5.2, "Fixed-point format".
constexpr std::array kinds = std::to_array<Kind>({{cal_inertial, "CalInertialAndMag", inertial},
                                                  {8, "RawInertialAndMag", raw_inertial},
                                                  {10, "Quaternion", quaternion},
                                                  {7, "CalBattAndTherm", battery},
                                                  {6, "RawBattAndTherm", raw_battery}});

/// The packets of a file, one after another.
class PacketStream {
 public:
  explicit PacketStream(const RandomBytes& bytes) : bytes_(bytes) {}

  /// The next good packet; nullptr at the end.
  Result<const Packet*> next() {
    for (;;) {
      while (at_ < filled_) {
        const auto outcome = decoder_.take(static_cast<std::uint8_t>(buffer_[at_++]));
        if (outcome == Decoder::Outcome::more) continue;
        ++packets_;
        if (outcome == Decoder::Outcome::packet) return &decoder_.packet();
        if (damaged_++ == 0) first_damaged_ = begin_ + at_;
      }
      begin_ += filled_;
      const auto count = bytes_.read_at(begin_, buffer_);
      if (!count) return count.error();
      filled_ = *count;
      at_ = 0;
      if (filled_ == 0) return static_cast<const Packet*>(nullptr);
    }
  }
  [[nodiscard]] std::uint64_t position() const { return begin_ + at_; }

  [[nodiscard]] std::vector<Note> faults() const {
    std::vector<Note> notes;
    if (damaged_ > 0)
      notes.push_back({Severity::bad,
                       fmt::format("{} of {} packets are damaged, the first ends at byte {}: left "
                                   "out",
                                   damaged_, packets_, first_damaged_)});
    if (decoder_.is_inside())
      notes.push_back({Severity::bad, fmt::format("breaks off within a packet at byte {}; what was "
                                                  "read before is kept",
                                                  position())});
    return notes;
  }

 private:
  const RandomBytes& bytes_;
  Decoder decoder_;
  std::array<char, 1 << 16> buffer_{};
  std::size_t at_ = 0;
  std::size_t filled_ = 0;
  std::uint64_t begin_ = 0;  ///< file offset of the buffer
  std::uint64_t packets_ = 0;
  std::uint64_t damaged_ = 0;
  std::uint64_t first_damaged_ = 0;
};

using Counts = std::array<std::uint64_t, headers>;

/// Contents of a file: packets of each type, in total and until its first and last date and time.
struct Survey {
  Counts all{};
  Counts until_first{};
  Counts until_last{};
  std::optional<std::int64_t> first_s;
  std::int64_t last_s = 0;

  void add(const Packet& packet) {
    ++all[packet.header];
    const auto time_s = packet.date_time_s();
    if (!time_s) return;
    if (!first_s) {
      first_s = time_s;
      until_first = all;
    }
    last_s = *time_s;
    until_last = all;
  }
  [[nodiscard]] std::optional<double> rate_hz(std::uint8_t kind) const {
    if (!first_s) return std::nullopt;
    return rate_counted(until_last[kind] - until_first[kind],
                        static_cast<double>(last_s - *first_s));
  }
};

Result<Survey> survey_of(const RandomBytes& bytes) {
  Survey survey;
  const auto stream = std::make_unique<PacketStream>(bytes);
  for (;;) {
    const auto packet = stream->next();
    if (!packet) return packet.error();
    if (*packet == nullptr) return survey;
    survey.add(**packet);
  }
}

class Table final : public TableReader {
 public:
  Table(std::shared_ptr<const RandomBytes> bytes, const Kind& kind, const Survey& survey)
      : bytes_(std::move(bytes)), kind_(kind), stream_(*bytes_) {
    head_.format = "x-IMU";
    for (const Column& column : kind.columns) head_.headings.emplace_back(column.heading);
    head_.columns = head_.headings.size();
    head_.rows = survey.all[kind.header];
    head_.rate_hz = survey.rate_hz(kind.header);
    if (!head_.rate_hz) {
      head_.notes.push_back({Severity::info,
                             "the packets have no time and no date that their rate "
                             "could be counted by",
                             {Advice{"rate"}}});
      return;
    }
    const double before_s = static_cast<double>(survey.until_first[kind.header]) / *head_.rate_hz;
    head_.start_ns =
        (*survey.first_s - static_cast<std::int64_t>(std::llround(before_s))) * 1'000'000'000;
    head_.notes.push_back(
        {Severity::info,
         fmt::format("rate {} Hz: {} packets in the {} s between the first and last date and time",
                     *head_.rate_hz,
                     survey.until_last[kind.header] - survey.until_first[kind.header],
                     survey.last_s - *survey.first_s)});
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    std::size_t row = 0;
    while (row < into[0].size()) {
      const auto packet = stream_.next();
      if (!packet) return packet.error();
      if (*packet == nullptr) break;
      if ((*packet)->header != kind_.header) continue;
      for (std::size_t c = 0; c < kind_.columns.size(); ++c)
        into[c][row] = std::ldexp((*packet)->figure(c), -kind_.columns[c].bits);
      ++row;
    }
    return row;
  }
  [[nodiscard]] std::vector<Note> notes() const override {
    std::vector<Note> notes = stream_.faults();
    std::ranges::move(bytes_->notes(), std::back_inserter(notes));
    return notes;
  }
  [[nodiscard]] double fraction_read() const override {
    return bytes_->size() == 0
               ? 0.0
               : static_cast<double>(stream_.position()) / static_cast<double>(bytes_->size());
  }

 private:
  std::shared_ptr<const RandomBytes> bytes_;
  const Kind& kind_;
  PacketStream stream_;
  TableHead head_;
};

class File final : public TableFile {
 public:
  File(std::shared_ptr<const RandomBytes> bytes, const Survey& survey)
      : bytes_(std::move(bytes)), survey_(survey) {
    for (const Kind& kind : kinds) {
      if (survey_.all[kind.header] == 0) continue;
      kinds_.push_back(&kind);
      TableSummary& summary = summaries_.emplace_back();
      summary.name = kind.name;
      for (const Column& column : kind.columns) summary.headings.emplace_back(column.heading);
      summary.rows = survey_.all[kind.header];
      summary.rate_hz = survey_.rate_hz(kind.header);
    }
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return summaries_; }
  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t table,
                                                              const ReadOptions& options) override {
    return recording_reader_of(std::make_unique<Table>(bytes_, *kinds_[table], survey_), options);
  }

 private:
  std::shared_ptr<const RandomBytes> bytes_;
  Survey survey_;
  std::vector<const Kind*> kinds_;
  std::vector<TableSummary> summaries_;
};

}  // namespace

bool claims(std::string_view head, std::string_view) {
  Decoder decoder;
  std::size_t good = 0;
  for (const char c : head) {
    const auto outcome = decoder.take(static_cast<std::uint8_t>(c));
    if (outcome == Decoder::Outcome::damaged) return false;
    constexpr std::size_t enough = 2;  // one in 65 536 random byte sequences would have as many
    if (outcome == Decoder::Outcome::packet && ++good == enough) return true;
  }
  return false;
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  auto bytes = random_bytes_of(std::move(source), options.progress);
  if (!bytes) return bytes.error();
  std::shared_ptr<const RandomBytes> shared = std::move(bytes).value();
  const auto survey = survey_of(*shared);
  if (!survey) return survey.error();
  auto file = std::make_unique<File>(std::move(shared), *survey);
  if (file->tables().empty())
    return Error{Errc::too_few_samples, "holds packets of an x-IMU, but none of figures"};
  return std::unique_ptr<TableFile>(std::move(file));
}

std::optional<double> inertial_rate_hz(const RandomBytes& bytes) {
  const auto survey = survey_of(bytes);
  return survey ? survey->rate_hz(cal_inertial) : std::nullopt;
}

}  // namespace proofmass::io::ximu
