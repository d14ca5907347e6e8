#include "proofmass/acquire/framing/framing.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>

#include "proofmass/acquire/framing/frames.hpp"
#include "proofmass/acquire/framing/lines.hpp"
#include "proofmass/acquire/framing/words.hpp"

namespace proofmass::acquire {
namespace {

/// "AA55" is two bytes.
Result<std::string> sync_word(std::string_view hex) {
  std::string word;
  constexpr std::size_t longest = 16;
  const bool is_whole = !hex.empty() && hex.size() % 2 == 0 && hex.size() <= 2 * longest;
  for (std::size_t i = 0; is_whole && i < hex.size(); i += 2) {
    unsigned byte = 0;
    const char* const from = hex.data() + i;
    const auto [end, problem] = std::from_chars(from, from + 2, byte, 16);
    if (problem != std::errc{} || end != from + 2) break;
    word += static_cast<char>(byte);
  }
  if (word.empty() || word.size() != hex.size() / 2)
    return invalid(fmt::format(
        "framing=sync:{}: expected 1 to {} bytes in hexadecimal, as sync:AA55", hex, longest));
  return word;
}

std::optional<Framing> framing_named(std::string_view word, bool in_datagrams) {
  if (word == "lines") return Framing::lines;
  if (in_datagrams) return word == "packet" ? std::optional(Framing::packet) : std::nullopt;
  if (word == "cobs") return Framing::cobs;
  if (word == "slip") return Framing::slip;
  if (word.starts_with("sync:")) return Framing::sync;
  return std::nullopt;
}

Status choose_framing(SourceUri& uri, FramingOptions& options) {
  const std::string word = uri.value("framing").value_or("");
  options.fields = uri.value("fields").value_or("");
  const bool in_datagrams = options.carrier == Carrier::datagrams;
  const bool is_packet = in_datagrams && !options.fields.empty();
  const auto framing =
      framing_named(!word.empty() ? word : (is_packet ? "packet" : "lines"), in_datagrams);
  if (!framing)
    return invalid(
        fmt::format("framing={}: expected {}", word,
                    in_datagrams ? "lines or packet" : "lines, cobs, slip or sync:AA55"));
  options.framing = *framing;
  if (*framing == Framing::sync) {
    auto sync = sync_word(std::string_view(word).substr(5));
    if (!sync) return sync.error();
    options.sync = std::move(sync).value();
  }
  if (options.fields.empty() == (options.framing == Framing::lines)) return Done{};
  return options.fields.empty()
             ? invalid(
                   fmt::format("framing={}: expected fields=, as fields=u32 t_us, i16 x y z", word))
             : invalid("fields=: lines have no fields; expected framing=cobs, slip or sync:AA55");
}

}  // namespace

Result<FramingOptions> framing_options(SourceUri& uri, Carrier carrier) {
  FramingOptions options;
  options.carrier = carrier;
  if (const Status chosen = choose_framing(uri, options); !chosen) return chosen.error();
  const auto endian = uri.choice("endian", {"little", "big"});
  if (!endian) return endian.error();
  options.big_endian = *endian == "big";
  const std::string columns = uri.value("columns").value_or("");
  for (const std::string_view name : words_of(columns, ",")) options.columns.emplace_back(name);
  options.time = uri.value("time").value_or("");
  options.time_unit = uri.value("time-unit").value_or("");
  if (!options.time_unit.empty()) {
    const auto unit = uri.choice("time-unit", {"s", "ms", "us", "ns"});
    if (!unit) return unit.error();
  }
  options.counter = uri.value("counter").value_or("");
  options.unit = uri.value("unit").value_or("");
  options.scale = uri.value("scale").value_or("");
  const auto rate_hz = uri.number("rate", 0.0);
  if (!rate_hz) return rate_hz.error();
  options.rate_hz = rate_hz->value_or(0.0);
  return options;
}

Result<std::unique_ptr<Decoder>> Decoder::make(const FramingOptions& options) {
  return options.framing == Framing::lines ? make_line_decoder(options)
                                           : make_frame_decoder(options);
}

DecodeCounts Decoder::counts() const {
  DecodeCounts counts = counts_;
  counts.rows = rows_.rows();
  counts.lost = rows_.lost();
  counts.late = rows_.late();
  counts.untimed = rows_.untimed();
  return counts;
}

void Decoder::describe(SourceHead& head) const {
  const RowPlan& plan = rows_.plan();
  head.has_device_clock = plan.clock.has_value();
  for (const RowPlan::Column& column : plan.columns) head.recording.channels.push_back(column.head);
  head.settings.insert(head.settings.end(), settings_.begin(), settings_.end());
  if (!plan.clock) {
    head.recording.time.rate_hz = options_.rate_hz;
    if (options_.rate_hz > 0.0) head.recording.time.source = TimeSource::given_rate;
    return;
  }
  head.recording.time.source = TimeSource::stamps;
  head.recording.time.channel = plan.clock->name;
  // A pipe may deliver old data; only a date reveals their time.
  constexpr std::int64_t year_2000_ns = 946'684'800'000'000'000;
  constexpr std::int64_t year_2060_ns = 2'840'140'800'000'000'000;
  const auto first_ns = rows_.first_device_ns();
  if (!head.is_paced && first_ns && *first_ns > year_2000_ns && *first_ns < year_2060_ns)
    head.recording.time.start_ns = first_ns;
}

namespace {

Error no_rows(const Decoder& decoder, const OpenOptions& options, bool has_ended) {
  const std::string what = decoder.what_came();
  if (!what.empty()) return {Errc::device, what};
  if (has_ended) return {Errc::device, "ended before anything came"};
  return {Errc::device,
          fmt::format("nothing came within {} s: is it switched on, and does it send?",
                      static_cast<double>(options.patience.count()) * 1e-3)};
}

}  // namespace

Status await_rows(Decoder& decoder, const OpenOptions& options, const Pump& pump) {
  using std::chrono::milliseconds;
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + options.patience;
  constexpr milliseconds longest_wait{50};
  bool has_more = true;
  for (;;) {
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now());
    const bool is_last_chance = !has_more || left.count() <= 0;
    const auto settled = decoder.settle(is_last_chance);
    if (!settled) return settled.error();
    if (*settled && decoder.has_rows()) return Done{};
    if (is_last_chance) break;
    if (options.stopped && options.stopped())
      return Error{Errc::device, "stopped while it waited for the first rows"};
    const auto pumped = pump(std::min(left, longest_wait));
    if (!pumped) return pumped.error();
    has_more = *pumped;
  }
  return no_rows(decoder, options, !has_more);
}

}  // namespace proofmass::acquire
