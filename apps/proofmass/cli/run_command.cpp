#include "cli/run_command.hpp"

#include <exception>
#include <new>

#include "cli/command_line.hpp"
#include "cli/console.hpp"
#include "cli/distinct_files.hpp"
#include "cli/exit_status.hpp"
#include "serve/view_command.hpp"

namespace proofmass::app {
namespace {

int fail(ExitStatus status, const char* message) {
  show_error(message);
  return status;
}

}  // namespace

int run_command(int argc, char** argv) {
  try {
    if (argc == 4 && argv[1] == view_verb) {
      write_view(argv[2], argv[3]);
      return done;
    }
    const std::optional<Verb> verb = parse_command_line(argc, argv);
    if (verb) hold_apart(verb->files());
    if (verb) verb->run();
    return done;
  } catch (const Failure& failure) {
    return fail(failure.status(), failure.what());
  } catch (const std::bad_alloc&) {
    return fail(failed,
                "out of memory: give --from and --to to take less of the recording at once");
  } catch (const std::exception& error) {
    return fail(failed, error.what());
  }
}

}  // namespace proofmass::app
