#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flag_table.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "cli/plain_text.hpp"
#include "proofmass/core/new_file.hpp"
#include "proofmass/serve/bench.hpp"
#include "proofmass/serve/child_process.hpp"
#include "proofmass/serve/page.hpp"
#include "proofmass/serve/server.hpp"
#include "proofmass/serve/temporary.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct ServeCommand {
  std::string what = ".", listen = "127.0.0.1", estimate;
  int port = 0;
  bool no_browser = false;
  OutputFlags output;
};

void add_serve_flags(CLI::App& verb, ServeCommand& command) {
  constexpr int last_port = 65535;
  verb.add_option(
          "FOLDER", command.what,
          "a folder of recordings, one recording, or a live source as record takes it, such "
          "as sim:wheel (default: this folder)")
      ->type_name("");
  verb.add_option("--estimate", command.estimate,
                  "live estimate of the source: wheel, tilt or track (default: none)")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"wheel", "tilt", "track"}));
  verb.add_option("--port", command.port, "port to listen on (default: a free one)")
      ->type_name("N")
      ->check(CLI::Range(0, last_port));
  verb.add_option("--listen", command.listen,
                  "address to listen on; any but a loopback address lets other machines in "
                  "(default 127.0.0.1)")
      ->type_name("ADDR");
  verb.add_flag("--no-browser", command.no_browser, "open no browser");
  verb.add_flag("-q,--quiet", command.output.quiet, "print errors only")->group("Output");
  verb.footer("Example:\n  proofmass serve recordings/");
}

std::string own_path() {
  std::error_code problem;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", problem);
  if (problem) throw Failure(failed, "cannot find this program: " + problem.message());
  return path.string();
}

// Environment of this process, without the variables that affect colour or behaviour of the child.
std::vector<std::string> child_environment() {
  std::vector<std::string> out{"PROOFMASS_PROGRESS=lines", "NO_COLOR=1"};
  for (char** one = environ; *one != nullptr; ++one) {
    const std::string_view text = *one;
    if (!text.starts_with("PROOFMASS_PROGRESS=") && !text.starts_with("NO_COLOR="))
      out.emplace_back(text);
  }
  return out;
}

bool has_screen() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

// The link is passed through a file readable only by this user, since arguments of a process are
// visible to all.
void open_browser(const std::string& link, const std::string& folder) {
  const std::string file = folder + "/open.html";
  const std::string text = fmt::format(
      "<!doctype html><meta charset=\"utf-8\"><title>Proofmass</title>"
      "<meta http-equiv=\"refresh\" content=\"0;url={0}\"><a href=\"{0}\">Proofmass</a>\n",
      link);
  if (!write_file(file, text)) return;
  auto child = serve::ChildProcess::start(
      {{"/bin/sh", "-c", "exec setsid -f xdg-open \"$1\" >/dev/null 2>&1", "sh", file},
       "/",
       child_environment()});
  if (!child) return;
  // The result is not checked, since the link is printed as well.
  serve::ChildProcess opener = std::move(child).value();
  (void)opener.follow([](std::string_view) {}, [] { return interruption_waits(); });
}

void warn_of_others(const ServeCommand& command) {
  if (serve::is_loopback(command.listen)) return;
  show_notes(
      {{Severity::warning,
        fmt::format("--listen {}: anybody who can reach this machine and has the link can read "
                    "this folder and add to it; nothing is encrypted",
                    command.listen)}},
      "", command.output);
}

std::string temporary_place() {
  std::error_code failed;
  const auto place = std::filesystem::temp_directory_path(failed);
  return failed ? "/tmp" : place.string();
}

// "sim:wheel", and no file of that name.
bool is_source(const std::string& what) {
  std::error_code ignored;
  return what.find(':') != std::string::npos && !std::filesystem::exists(what, ignored);
}

// Runs until a signal ends it.
void serve_folder(const ServeCommand& command) {
  const bool is_live = is_source(command.what);
  if (!is_live && !command.estimate.empty())
    throw Failure(usage, "--estimate: FOLDER must be a live source, such as sim:wheel");
  const auto folder = need(serve::Folder::open(is_live ? "." : command.what), Stage::reading);
  const auto work = need(serve::TemporaryFolder::make(temporary_place()), Stage::writing);
  const std::string token = need(serve::random_token(), Stage::reading);
  serve::Bench bench({.folder = folder,
                      .program = own_path(),
                      .environment = child_environment(),
                      .work_folder = work.path(),
                      .verbs_json = flag_table()});
  const std::string page(serve::page_html());
  const auto server =
      need(serve::Server::listen(
               {.address = command.listen,
                .port = static_cast<std::uint16_t>(command.port),
                .token = token,
                .upload_folder = folder.path(),
                .page = page,
                .content_security_policy = serve::content_security_policy(page),
                .live = [&](const std::shared_ptr<serve::LiveListener>& from,
                            std::string_view message) { return bench.take(from, message); }},
               [&](const serve::Request& request) { return bench.answer(request); }),
           Stage::reading);
  if (is_live) {
    const Status watched = bench.watch(command.what, command.estimate);
    if (!watched)
      throw Failure(status_of(watched.error(), Stage::reading), watched.error().at(command.what));
  }
  const std::string link =
      fmt::format("http://{}:{}/?token={}", serve::in_link(command.listen), server->port(), token);
  warn_of_others(command);
  print_out(link + "\n");
  if (!command.no_browser && has_screen()) open_browser(link, work.path());
  server->run(interruption_waits);
  // While the server is still there for those who listen.
  bench.end_live();
}

void run_serve(const ServeCommand& command) {
  ignore_broken_pipes();
  interruption_was_awaited();
  without_interruption([&] { serve_folder(command); });
}

}  // namespace

Verb serve_verb() {
  return make_verb<ServeCommand>(
      {.name = "serve",
       .group = "Look",
       .help = "recordings and analyses of a folder, or a live source, on a page in the browser"},
      add_serve_flags, run_serve);
}

}  // namespace proofmass::app
