#include "cli/distinct_files.hpp"

#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "proofmass/core/new_file.hpp"

namespace proofmass::app {
void hold_apart(const Files& files) {
  for (std::size_t k = 0; k < files.written.size(); ++k) {
    const auto& [flag, path] = files.written[k];
    const auto refuse_if_read = [&](const std::vector<std::string>& read) {
      for (const std::string& input : read)
        if (is_same_or_within(path, input))
          throw Failure(usage, fmt::format("{} {}: would replace the input {}: name another file",
                                           flag, path, input));
    };
    refuse_if_read(files.read);
    if (flag != "--update-sensor") refuse_if_read(files.sensors);
    for (std::size_t j = 0; j < k; ++j)
      if (is_same_or_within(path, files.written[j].path))
        throw Failure(usage, fmt::format("{} and {} both name {}: name two files",
                                         files.written[j].flag, flag, path));
  }
}

}  // namespace proofmass::app
