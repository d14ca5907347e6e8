#include "proofmass/io/reading/labelled_reader.hpp"

#include <span>
#include <utility>

namespace proofmass::io {
namespace {

class LabelledReader final : public RecordingReader {
 public:
  LabelledReader(std::unique_ptr<RecordingReader> reader,
                 std::vector<Label> labels,
                 std::string channel)
      : reader_(std::move(reader)), labels_(std::move(labels)), channel_(std::move(channel)) {}

  [[nodiscard]] const RawHead& head() const override { return reader_->head(); }
  [[nodiscard]] Status next(std::size_t most, RawRows& rows) override {
    return reader_->next(most, rows);
  }
  void finish(Recording& recording) override {
    reader_->finish(recording);
    recording.labels = labels_;
    recording.label_channel = channel_;
  }
  [[nodiscard]] double fraction_read() const override { return reader_->fraction_read(); }

 private:
  std::unique_ptr<RecordingReader> reader_;
  std::vector<Label> labels_;
  std::string channel_;
};

bool are_labels(std::span<const Label> labels, std::uint64_t rows) {
  std::uint64_t unlabelled = 0;
  for (const Label& label : labels) {
    if (label.text.empty() || label.first < unlabelled || label.last < label.first ||
        label.last >= rows)
      return false;
    unlabelled = label.last + 1;
  }
  return !labels.empty();
}

}  // namespace

std::unique_ptr<RecordingReader> labelled(std::unique_ptr<RecordingReader> reader,
                                          std::vector<Label> labels,
                                          std::string channel,
                                          std::uint64_t rows) {
  if (!are_labels(labels, rows)) return reader;
  return std::make_unique<LabelledReader>(std::move(reader), std::move(labels),
                                          channel.empty() ? "label" : std::move(channel));
}

}  // namespace proofmass::io
