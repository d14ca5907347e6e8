#include "serve/view_command.hpp"

#include <optional>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "input/block_reader.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/serve/view/file.hpp"

namespace proofmass::app {
namespace {

void keep(const Status& status) {
  if (!status) throw Failure(status_of(status.error(), Stage::writing), status.error());
}

}  // namespace

void write_view(const std::string& file, const std::string& folder) {
  const InputFlags flags;
  const Progress progress = progress_bar({});
  auto opened = open_input(file, flags, progress);
  if (auto* recording = std::get_if<Recording>(&opened)) {
    auto writer = need(serve::ViewWriter::create(folder, *recording, !recording->time.is_uniform()),
                       Stage::writing);
    keep(writer.add(io::whole_of(*recording)));
    return keep(writer.finish(*recording));
  }
  const std::vector<sensor::SensorModel> models;
  PieceSource source(std::get<io::RecordingStream>(std::move(opened)), flags, models);
  auto writer =
      need(serve::ViewWriter::create(folder, source.head(), source.has_stamps()), Stage::writing);
  for (Block block = source.next(); block.rows() > 0; block = source.next())
    keep(writer.add(block));
  keep(writer.finish(source.head()));
}

}  // namespace proofmass::app
