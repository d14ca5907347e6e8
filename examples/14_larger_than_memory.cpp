// A recording that is read and written block by block, whatever its format: audited on the way, and
// converted to MCAP.
#include <cstdio>
#include <string>
#include <variant>

#include "proofmass/io/recording_stream.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/signal/running_audit.hpp"

namespace pm = proofmass;

namespace {

void hold(const pm::Status& status) {
  if (!status) throw pm::ResultError(status.error());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s RECORDING NEW.mcap\n", argv[0]);
    return 2;
  }
  try {
    // A limit of 0 bytes: as a stream, even if it is small.
    auto opened = pm::io::open_recording(argv[1], {}, 0).value();
    auto& stream = std::get<pm::io::RecordingStream>(opened);

    const pm::io::WriterHead head{.recording = stream.head(), .has_stamps = stream.has_stamps()};
    const auto writer = pm::io::open_writer(argv[2], head, {}).value();
    pm::signal::RunningAudit audit(stream.head());
    for (;;) {
      const pm::Block block = stream.next().value();
      if (block.rows() == 0) break;
      audit.add(block);
      hold(writer->write(block));
    }
    hold(writer->finish(stream.head()));

    const auto found = audit.finish(stream.head());
    for (const auto& channel : found.channels)
      std::printf("%s: %.6g ± %.2g %s\n", channel.name.c_str(), channel.moments.mean,
                  channel.moments.std(), channel.unit.symbol.c_str());
    std::printf("%zu samples, %zu gaps\n", found.samples, found.timing.gap_count);

    const auto again = pm::io::read_recording(argv[2], {}).value();
    return again.samples() == found.samples ? 0 : 1;
  } catch (const pm::ResultError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
