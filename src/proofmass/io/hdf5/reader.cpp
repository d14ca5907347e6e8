#include "proofmass/io/hdf5/reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "proofmass/io/bytes/library_file.hpp"
#include "proofmass/io/hdf5/choice.hpp"
#include "proofmass/io/hdf5/library.hpp"
#include "proofmass/io/hdf5/stream.hpp"
#include "proofmass/io/hdf5/table.hpp"
#include "proofmass/io/reading/labelled_reader.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io::hdf5 {
namespace {

class Tables final : public TableFile {
 public:
  Tables(OpenFile file, std::unique_ptr<TableReader> first)
      : file_(std::move(file)), first_(std::move(first)) {
    const TableHead& head = first_->head();
    summary_[0] = {
        .name = {}, .headings = head.headings, .rows = head.rows, .rate_hz = head.rate_hz};
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return summary_; }
  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t,
                                                              const ReadOptions& options) override {
    if (!first_) {
      auto table = open_table(file_, options);
      if (!table) return table.error();
      first_ = std::move(table).value();
    }
    auto opened = recording_reader_of(std::exchange(first_, nullptr), options);
    if (!opened) return opened;
    return labelled(std::move(opened).value(), file_.catalogue.runs, file_.catalogue.run_channel,
                    summary_[0].rows.value_or(0));
  }

 private:
  OpenFile file_;
  std::unique_ptr<TableReader> first_;  ///< until it is requested
  std::array<TableSummary, 1> summary_;
};

bool is_matlab(std::string_view head) {
  return head.starts_with("MATLAB 7.");
}

}  // namespace

bool claims(std::string_view head, std::string_view) {
  using namespace std::literals;
  constexpr std::array<std::size_t, 4> places{0, 512, 1024, 2048};
  return is_matlab(head) || std::ranges::any_of(places, [&](std::size_t place) {
           return head.size() > place && head.substr(place).starts_with("\x89HDF\r\n\x1A\n"sv);
         });
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  const auto head = source->peek(16);
  if (!head) return head.error();
  const bool matlab = is_matlab(*head);
  if (!has_library())
    return Error{Errc::unsupported,
                 matlab ? "is a MAT file of version 7.3, and this program was built without the "
                          "HDF5 library: use save(…, '-v7') in MATLAB"
                        : "is HDF5, and this program was built without the HDF5 library: export "
                          "the dataset as CSV"};
  auto spooled = library_file_of(*source, options.progress);
  if (!spooled) return spooled.error();
  OpenFile file{.file = std::move(spooled).value(), .is_matlab = matlab};
  auto catalogue = list_in_child(file.file, matlab);
  if (!catalogue) return catalogue.error();
  file.catalogue = std::move(catalogue).value();
  file.arrays = arrays_of(file.catalogue);
  file.notes = source->notes();
  auto first = open_table(file, options);
  if (!first) return first.error();
  return std::unique_ptr<TableFile>(
      std::make_unique<Tables>(std::move(file), std::move(first).value()));
}

}  // namespace proofmass::io::hdf5
