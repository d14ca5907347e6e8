#include "proofmass/acquire/recorder.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/recorder/session.hpp"
#include "proofmass/acquire/source_uri.hpp"

namespace proofmass::acquire {
namespace {

Status check(const RecordOptions& options) {
  if (options.keeps_file && (options.path.empty() || options.path == "-"))
    return invalid("a recording is written to a file: expected a name such as run.mcap");
  for (const auto& [name, value] :
       {std::pair{"duration", options.duration_s}, std::pair{"time of a file", options.rotate_s}})
    if (value && !(*value > 0.0 && std::isfinite(*value)))
      return invalid(fmt::format("the {} is {} s: expected more than 0", name, *value));
  if (options.trigger && !(options.trigger->before_s >= 0.0 && options.trigger->after_s >= 0.0 &&
                           std::isfinite(options.trigger->level)))
    return invalid("the trigger: expected a level, and times of 0 s or more before and after it");
  return Done{};
}

}  // namespace

Result<RecordSummary> record(const OpenSource& open,
                             const RecordOptions& options,
                             const RecordWatch& watch,
                             const MakeAnalysis& analysis) {
  if (const Status checked = check(options); !checked) return checked.error();
  RecordSession session(open, options, watch, analysis,
                        options.keeps_file ? create_part_file : create_no_file);
  auto summary = session.run();
  if (!summary || options.keeps_file) return summary;
  RecordSummary watched = std::move(summary).value();
  watched.files.clear();
  return watched;
}

}  // namespace proofmass::acquire
