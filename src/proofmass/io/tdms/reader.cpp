#include "proofmass/io/tdms/reader.hpp"

#include <fmt/format.h>

#include "proofmass/io/reading/labelled_reader.hpp"
#include "proofmass/io/tdms/group_reader.hpp"

namespace proofmass::io::tdms {
namespace {

/// The labels in our own files: properties label[0]_text, label[0]_first, label[0]_last, …
std::vector<Label> labels_in(const Properties& properties) {
  constexpr double most_samples = 0x1p53;
  std::vector<Label> labels;
  for (std::size_t i = 0;; ++i) {
    const std::string prefix = fmt::format("label[{}]_", i);
    const auto first = number_of(properties, prefix + "first");
    const auto last = number_of(properties, prefix + "last");
    const bool is_label = first && last && *first >= 0.0 && *first <= *last && *last < most_samples;
    if (!is_label) return labels;
    labels.push_back({text_of(properties, prefix + "text"), static_cast<std::size_t>(*first),
                      static_cast<std::size_t>(*last)});
  }
}

class File final : public TableFile {
 public:
  explicit File(std::shared_ptr<const Contents> contents) : contents_(std::move(contents)) {
    for (const Group& group : contents_->groups)
      summaries_.push_back({group.name, group.headings, group.rows, group.rate_hz});
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return summaries_; }
  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t table,
                                                              const ReadOptions& options) override {
    auto opened = open_table(contents_, table);
    if (!opened) return opened.error();
    auto reader = recording_reader_of(std::move(opened).value(), options);
    if (!reader || contents_->groups.size() > 1) return reader;
    const Properties& said = contents_->map.properties_of("");
    return labelled(std::move(reader).value(), labels_in(said), text_of(said, "label_channel"),
                    contents_->groups[table].rows);
  }

 private:
  std::shared_ptr<const Contents> contents_;
  std::vector<TableSummary> summaries_;
};

}  // namespace

bool claims(std::string_view head, std::string_view /*file_name*/) {
  return head.starts_with("TDSm") || head.starts_with("TDSh");
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  auto bytes = random_bytes_of(std::move(source), options.progress);
  if (!bytes) return bytes.error();
  auto contents = read_contents(std::move(bytes).value());
  if (!contents) return contents.error();
  return std::unique_ptr<TableFile>(std::make_unique<File>(std::move(contents).value()));
}

}  // namespace proofmass::io::tdms
