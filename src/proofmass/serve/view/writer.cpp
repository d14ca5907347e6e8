#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "proofmass/core/new_file.hpp"
#include "proofmass/serve/view/file.hpp"
#include "proofmass/serve/view/marks.hpp"
#include "proofmass/serve/view/names.hpp"

namespace proofmass::serve {
namespace {

nlohmann::ordered_json head_json(const ViewHead& head) {
  using Json = nlohmann::ordered_json;
  Json channels = Json::array(), rests = Json::array();
  for (const Channel& channel : head.channels)
    channels.push_back({{"name", channel.name},
                        {"unit", channel.unit.symbol},
                        {"quantity", std::string(name_of(channel.unit.quantity))},
                        {"to_si", channel.unit.to_si}});
  for (const Stretch& rest : head.rests) rests.push_back({rest.from_s, rest.to_s});
  return {{"samples", head.samples},           {"rate_hz", head.rate_hz},    {"end_s", head.end_s},
          {"has_stamps", head.has_stamps},     {"channels", channels},       {"rests", rests},
          {"why_no_rests", head.why_no_rests}, {"knocks_s", head.outliers_s}};
}

}  // namespace

struct ViewWriter::State {
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  State(std::string in, const Recording& head, bool stamps)
      : folder(std::move(in)), has_stamps(stamps), pyramid(head) {}

  [[nodiscard]] Error failed() const {
    return {Errc::unwritable, folder + ": " + std::strerror(errno)};
  }
  [[nodiscard]] Status open(const std::string& name, File& file) const {
    file.reset(std::fopen((folder + "/" + name).c_str(), "wbe"));
    if (!file) return failed();
    return Done{};
  }
  [[nodiscard]] Status write(View<double> values, const File& file) const {
    if (std::fwrite(values.data(), sizeof(double), values.size(), file.get()) != values.size())
      return failed();
    return Done{};
  }

  std::string folder;
  bool has_stamps;
  io::PyramidBuilder pyramid;
  std::vector<File> channels;
  File stamps;
};

ViewWriter::ViewWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ViewWriter::ViewWriter(ViewWriter&&) noexcept = default;
ViewWriter::~ViewWriter() = default;

Result<ViewWriter> ViewWriter::create(const std::string& folder,
                                      const Recording& head,
                                      bool has_stamps) {
  auto state = std::make_unique<State>(folder, head, has_stamps);
  for (std::size_t k = 0; k < head.channels.size(); ++k) {
    const Status opened = state->open(view_channel_name(k), state->channels.emplace_back());
    if (!opened) return opened.error();
  }
  if (has_stamps)
    if (const Status opened = state->open(view_stamps_name, state->stamps); !opened)
      return opened.error();
  return ViewWriter(std::move(state));
}

Status ViewWriter::add(const Block& block) {
  for (std::size_t k = 0; k < block.channels.size(); ++k)
    if (const Status s = state_->write(block.channels[k], state_->channels[k]); !s) return s;
  if (state_->has_stamps)
    if (const Status s = state_->write(block.stamps_s, state_->stamps); !s) return s;
  state_->pyramid.add(block);
  return Done{};
}

Status ViewWriter::finish(const Recording& recording) {
  for (const State::File& file : state_->channels)
    if (std::fflush(file.get()) != 0) return state_->failed();
  if (state_->stamps && std::fflush(state_->stamps.get()) != 0) return state_->failed();
  const io::Pyramid pyramid = state_->pyramid.finish();
  ViewHead head{.samples = pyramid.samples,
                .rate_hz = recording.time.rate_hz,
                .end_s = pyramid.end_s,
                .has_stamps = state_->has_stamps,
                .channels = recording.channels,
                .rests = {},
                .why_no_rests = {},
                .outliers_s = {}};
  if (const Status s = find_marks(state_->folder, head); !s) return s;
  if (const Status s = io::store_pyramid(pyramid, state_->folder + "/" + view_channel_name(0)); !s)
    return s;
  return write_file(state_->folder + "/" + view_head_name,
                    head_json(head).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace proofmass::serve
