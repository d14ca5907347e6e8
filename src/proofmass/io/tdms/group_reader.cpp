#include "proofmass/io/tdms/group_reader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

#include "proofmass/io/tdms/column.hpp"

namespace proofmass::io::tdms {
namespace {

/// A column of the table: its inputs and their conversion.
struct Reading {
  std::vector<Column> sources;
  std::optional<Scaling> scaling;
};

class Table final : public TableReader {
 public:
  Table(std::shared_ptr<const Contents> contents, const Group& group)
      : contents_(std::move(contents)), group_(group), window_(*contents_->bytes) {
    head_.format = "TDMS";
    head_.columns = group.channels.size();
    head_.headings = group.headings;
    head_.rate_hz = group.rate_hz;
    head_.start_ns = group.start_ns;
    head_.rows = group.rows;
    head_.notes = contents_->notes;
    std::ranges::copy(group.notes, std::back_inserter(head_.notes));
  }

  Status prepare() {
    for (std::size_t c = 0; c < group_.channels.size(); ++c)
      if (const Status added = add_column(c); !added) return added;
    note_scalings();
    return Done{};
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] std::vector<Note> notes() const override { return contents_->bytes->notes(); }
  [[nodiscard]] double fraction_read() const override {
    return static_cast<double>(rows_read_) / static_cast<double>(group_.rows);
  }

  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    const std::size_t wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(into[0].size(), group_.rows - rows_read_));
    for (std::size_t done = 0; done < wanted;) {
      const std::size_t rows = std::min(wanted - done, comfortable_rows());
      for (std::size_t c = 0; c < readings_.size(); ++c)
        if (const Status read = read_column(readings_[c], into[c].subspan(done, rows)); !read)
          return read.error();
      done += rows;
    }
    rows_read_ += wanted;
    return wanted;
  }

 private:
  Status add_column(std::size_t c) {
    const std::uint32_t channel = group_.channels[c];
    const Map& map = contents_->map;
    Reading reading;
    auto scaling = scaling_of(map, channel);
    if (scaling) {
      reading.scaling = std::move(scaling).value();
    } else {
      head_.notes.push_back(
          {Severity::warning, fmt::format("{}: the scaling that the file asks for cannot be "
                                          "computed ({}): the values are as stored",
                                          map.objects[channel].name, scaling.error().message)});
    }
    const std::vector<std::uint32_t> scalers = scalers_of(map, channel);
    if (reading.scaling && !scalers.empty()) {
      for (const std::uint32_t scaler : reading.scaling->sources())
        reading.sources.emplace_back(map, channel, scaler);
    } else {
      reading.sources.emplace_back(map, channel, scalers.empty() ? 0 : scalers.front());
    }
    if (map.objects[channel].kind == Kind::instant)
      if (const Status counted = count_from_first(c, reading); !counted) return counted;
    if (group_.time_column == c && map.objects[channel].kind != Kind::instant)
      head_.stamps = DeclaredStamps{c, *parse_unit("s"), {Int128{*group_.start_ns}, -9}};
    readings_.push_back(std::move(reading));
    return Done{};
  }

  /// Timestamps are read as seconds from the first.
  Status count_from_first(std::size_t c, Reading& reading) {
    const auto first = reading.sources.front().first_instant(window_);
    if (!first) return first.error();
    const Int128 origin_ns = *first ? (*first)->wide_ns() : Int128{0};
    reading.sources.front().count_from(origin_ns);
    if (group_.time_column == c)
      head_.stamps = DeclaredStamps{c, *parse_unit("s"), {origin_ns, -9}};
    return Done{};
  }

  void note_scalings() {
    std::vector<std::pair<std::string, std::string>> noted;  // how, who
    for (std::size_t c = 0; c < readings_.size(); ++c) {
      if (!readings_[c].scaling) continue;
      const std::string words = readings_[c].scaling->words();
      const std::string& name = contents_->map.objects[group_.channels[c]].name;
      auto same = std::ranges::find(noted, words, &std::pair<std::string, std::string>::first);
      constexpr std::size_t longest = 200;
      if (same == noted.end())
        noted.emplace_back(words, name);
      else if (same->second.size() < longest)
        same->second += ", " + name;
    }
    constexpr std::size_t most_listed = 16;
    for (std::size_t i = 0; i < std::min(noted.size(), most_listed); ++i)
      head_.notes.push_back({Severity::info, fmt::format("{}: scaled as the file says: {}",
                                                         noted[i].second, noted[i].first)});
  }

  [[nodiscard]] std::size_t comfortable_rows() const {
    std::size_t rows = std::size_t{1} << 14;
    for (const Reading& reading : readings_)
      for (const Column& source : reading.sources) rows = std::min(rows, source.comfortable());
    return rows;
  }

  Status read_column(Reading& reading, std::span<double> into) {
    if (!reading.scaling) return reading.sources.front().read(window_, into);
    stored_.resize(std::max(stored_.size(), reading.sources.size()));
    for (std::size_t s = 0; s < reading.sources.size(); ++s) {
      stored_[s].resize(std::max(stored_[s].size(), into.size()));
      const auto part = std::span(stored_[s]).first(into.size());
      if (const Status read = reading.sources[s].read(window_, part); !read) return read;
    }
    reading.scaling->apply(std::span(stored_).first(reading.sources.size()), into);
    return Done{};
  }

  std::shared_ptr<const Contents> contents_;
  const Group& group_;
  Window window_;
  TableHead head_;
  std::vector<Reading> readings_;
  std::vector<std::vector<double>> stored_;
  std::uint64_t rows_read_ = 0;
};

constexpr std::size_t longest_text = 300;

/// Descriptive texts of the file: author, title.
std::string self_description(const Properties& properties) {
  std::string words;
  for (const auto& [name, value] : properties) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr || text->empty() || text->size() > longest_text) continue;
    if (name.starts_with("label[")) continue;
    std::string line = fmt::format("{}{}: {}", words.empty() ? "" : "; ", name, *text);
    std::ranges::replace_if(line, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    if (words.size() + line.size() > longest_text) return words + "; …";
    words += line;
  }
  return words;
}

std::vector<Note> notes_of(const Map& map, const std::vector<Group>& groups) {
  std::vector<Note> notes;
  std::uint64_t most_rows = 0;
  for (const Group& group : groups) most_rows = std::max(most_rows, group.rows);
  std::string segments = fmt::format("{} segment{}", map.segments, map.segments == 1 ? "" : "s");
  constexpr std::uint64_t few_segments = 100;
  constexpr std::uint64_t few_values = 100;
  if (map.data_segments > few_segments && most_rows / map.data_segments < few_values)
    segments += fmt::format(
        ", {} values in each: fragmented, which makes it slow to other programs; "
        "proofmass convert defragments",
        most_rows / map.data_segments);
  notes.push_back({Severity::info, std::move(segments)});
  const std::string words = self_description(map.properties_of(""));
  if (!words.empty()) notes.push_back({Severity::info, words});
  std::ranges::copy(map.notes, std::back_inserter(notes));
  std::ranges::copy(notes_on_unread(map), std::back_inserter(notes));
  return notes;
}

}  // namespace

Result<std::shared_ptr<const Contents>> read_contents(std::unique_ptr<const RandomBytes> bytes) {
  auto map = map_file(*bytes);
  if (!map) return map.error();
  auto contents = std::make_shared<Contents>();
  contents->bytes = std::move(bytes);
  contents->map = std::move(map).value();
  contents->groups = group_channels(contents->map);
  contents->notes = notes_of(contents->map, contents->groups);
  if (!contents->groups.empty()) return std::shared_ptr<const Contents>(std::move(contents));
  for (const Note& note : contents->notes)
    if (note.severity != Severity::info)
      return Error{Errc::too_few_samples, "holds no values: " + note.text};
  return Error{Errc::too_few_samples,
               fmt::format("holds no values in its {} segments", contents->map.segments)};
}

Result<std::unique_ptr<TableReader>> open_table(std::shared_ptr<const Contents> contents,
                                                std::size_t group) {
  const Group& chosen = contents->groups[group];
  auto table = std::make_unique<Table>(std::move(contents), chosen);
  if (const Status ready = table->prepare(); !ready) return ready.error();
  return std::unique_ptr<TableReader>(std::move(table));
}

}  // namespace proofmass::io::tdms
