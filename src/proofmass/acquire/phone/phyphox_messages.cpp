#include "proofmass/acquire/phone/phyphox_messages.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "proofmass/acquire/phone/phone_stream_merge.hpp"
#include "proofmass/io/json_leaves.hpp"

namespace proofmass::acquire {
namespace {

/// Maximum number of buffers and similar entries, more than any experiment has; others are skipped.
constexpr std::size_t most_entries = 4096;

/// Removes "name." or a final "name" from the beginning of a path.
bool take_word(std::string_view& path, std::string_view name) {
  if (!path.starts_with(name)) return false;
  const std::string_view rest = path.substr(name.size());
  if (!rest.empty() && rest.front() != '.') return false;
  path = rest.substr(std::min<std::size_t>(1, rest.size()));
  return true;
}

/// Removes "12." or a final "12".
std::optional<std::size_t> take_number(std::string_view& path) {
  std::size_t number = 0;
  const auto [end, problem] = std::from_chars(path.data(), path.data() + path.size(), number);
  if (problem != std::errc{} || number >= most_entries) return std::nullopt;
  std::string_view rest = path.substr(static_cast<std::size_t>(end - path.data()));
  if (!rest.empty() && rest.front() != '.') return std::nullopt;
  path = rest.substr(std::min<std::size_t>(1, rest.size()));
  return number;
}

template <class Entry>
Entry& entry_at(std::vector<Entry>& entries, std::size_t number) {
  if (entries.size() <= number) entries.resize(number + 1);
  return entries[number];
}

std::string text_in(const io::JsonLeaf& leaf) {
  return std::string(leaf.text.value_or(""));
}

void take_buffer(PhyphoxConfig& config, std::string_view path, const io::JsonLeaf& leaf) {
  const auto number = take_number(path);
  if (!number) return;
  PhyphoxConfig::Buffer& buffer = entry_at(config.buffers, *number);
  if (path == "name") buffer.name = text_in(leaf);
  if (path == "size" && leaf.whole && *leaf.whole > 0)
    buffer.rows = static_cast<std::uint64_t>(*leaf.whole);
}

void take_input(PhyphoxConfig& config, std::string_view path, const io::JsonLeaf& leaf) {
  const auto number = take_number(path);
  if (!number) return;
  PhyphoxConfig::Input& input = entry_at(config.inputs, *number);
  if (path == "source") input.source = text_in(leaf);
  if (take_word(path, "outputs") && take_number(path) && leaf.text)
    input.outputs.emplace(path, *leaf.text);
}

/// Sets and their sources are numbered; a source's label and buffer are in any order.
void take_export(PhyphoxConfig& config,
                 std::string_view path,
                 const io::JsonLeaf& leaf,
                 std::size_t& source) {
  const auto set = take_number(path);
  if (!set || !take_word(path, "sources")) return;
  const auto number = take_number(path);
  if (!number || config.exports.size() >= most_entries) return;
  const std::size_t here = *set * most_entries + *number;
  if (config.exports.empty() || source != here)
    config.exports.push_back({.label = {}, .buffer = {}, .set = *set});
  source = here;
  if (path == "label") config.exports.back().label = text_in(leaf);
  if (path == "buffer") config.exports.back().buffer = text_in(leaf);
}

}  // namespace

Result<PhyphoxConfig> parse_phyphox_config(std::string_view text) {
  PhyphoxConfig config;
  std::size_t source = 0;
  const Status read = io::visit_json(text, [&](const io::JsonLeaf& leaf) {
    std::string_view path = leaf.path;
    if (path == "title") config.title = text_in(leaf);
    if (take_word(path, "buffers")) return take_buffer(config, path, leaf);
    if (take_word(path, "inputs")) return take_input(config, path, leaf);
    if (take_word(path, "export")) take_export(config, path, leaf, source);
  });
  if (!read) return read.error();
  if (config.buffers.empty())
    return Error{Errc::corrupt, "names no buffers: expected phyphox 1.1.6 or newer"};
  return config;
}

namespace {

// The values of the buffers, those of one after the other.
class BufferValues {
 public:
  BufferValues(const std::vector<std::string>& names, PhyphoxReply& out)
      : names_(names), out_(out) {}
  void take(std::string_view path, const io::JsonLeaf& leaf) {
    for (std::size_t tried = 0; tried < names_.size(); ++tried) {
      std::string_view rest = path;
      if (take_word(rest, names_[current_])) {
        out_.is_there[current_] = true;
        if (take_word(rest, "buffer")) out_.buffers[current_].push_back(leaf.figure);
        return;
      }
      current_ = (current_ + 1) % names_.size();
    }
  }

 private:
  const std::vector<std::string>& names_;
  PhyphoxReply& out_;
  std::size_t current_ = 0;
};

}  // namespace

Status parse_phyphox_reply(std::string_view text,
                           const std::vector<std::string>& names,
                           PhyphoxReply& out) {
  out.buffers.resize(names.size());
  for (auto& buffer : out.buffers) buffer.clear();
  out.is_there.assign(names.size(), false);
  out.session.clear();
  bool has_status = false;
  BufferValues values(names, out);
  const Status read = io::visit_json(text, [&](const io::JsonLeaf& leaf) {
    std::string_view path = leaf.path;
    if (take_word(path, "buffer")) return values.take(path, leaf);
    if (path == "status.session") out.session = text_in(leaf);
    if (path != "status.measuring") return;
    has_status = true;
    out.measuring = leaf.figure == 1.0;
  });
  if (!read) return read.error();
  if (!has_status) return Error{Errc::corrupt, "does not say whether it measures"};
  return Done{};
}

std::size_t level_buffers(std::span<std::vector<double>> buffers) {
  constexpr double latest_s = static_cast<double>(PhoneStreamMerge::largest_ns) * 1e-9;
  std::size_t rows = buffers.front().size(), kept = 0;
  for (const auto& buffer : buffers) rows = std::min(rows, buffer.size());
  for (std::size_t k = 0; k < rows; ++k) {
    if (!(std::abs(buffers.front()[k]) < latest_s)) continue;
    for (auto& buffer : buffers) buffer[kept] = buffer[k];
    ++kept;
  }
  for (auto& buffer : buffers) buffer.resize(kept);
  return rows - kept;
}

Result<bool> parse_phyphox_result(std::string_view text) {
  bool done = false;
  const Status read = io::visit_json(text, [&](const io::JsonLeaf& leaf) {
    if (leaf.path == "result") done = leaf.figure == 1.0;
  });
  if (!read) return read.error();
  return done;
}

Result<std::optional<double>> parse_phyphox_time(std::string_view text) {
  struct Event {
    bool is_start = false;
    double experiment_s = NAN, system_s = NAN;
  };
  std::vector<Event> events;
  const Status read = io::visit_json(text, [&](const io::JsonLeaf& leaf) {
    std::string_view path = leaf.path;
    const auto number = take_number(path);
    if (!number) return;
    Event& event = entry_at(events, *number);
    if (path == "event") event.is_start = leaf.text == "START";
    if (path == "experimentTime") event.experiment_s = leaf.figure;
    if (path == "systemTime") event.system_s = leaf.figure;
  });
  if (!read) return read.error();
  const auto last = std::find_if(events.rbegin(), events.rend(), [](const Event& event) {
    return event.is_start && std::isfinite(event.system_s - event.experiment_s);
  });
  if (last == events.rend()) return std::optional<double>();
  return std::optional(last->system_s - last->experiment_s);
}

}  // namespace proofmass::acquire
