#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace proofmass::app {

inline constexpr const char* input_group = "Input";
inline constexpr const char* input_help_flag = "help-input";

/// Formats --help in two columns wrapped to `width`. The input flags, which are the same for every
/// verb, are replaced by a reference; with `shows_input` only they are listed.
class HelpFormat : public CLI::Formatter {
 public:
  HelpFormat(std::size_t width, bool shows_input) : width_(width), shows_input_(shows_input) {}

  [[nodiscard]] std::string make_description(const CLI::App* app) const override;
  [[nodiscard]] std::string make_positionals(const CLI::App* app) const override;
  [[nodiscard]] std::string make_group(std::string group,
                                       bool is_positional,
                                       std::vector<const CLI::Option*> options) const override;
  [[nodiscard]] std::string make_option(const CLI::Option* option,
                                        bool is_positional) const override;
  [[nodiscard]] std::string make_option_usage(const CLI::Option* option) const override;
  [[nodiscard]] std::string make_subcommand(const CLI::App* verb) const override;
  [[nodiscard]] std::string make_footer(const CLI::App* app) const override;

 private:
  [[nodiscard]] std::string entry(const std::string& name, const std::string& what) const;

  std::size_t width_;
  bool shows_input_;
};

/// Width of the terminal on standard output, limited to 50 … 100 columns; 80 without a terminal.
[[nodiscard]] std::size_t help_width();

/// The allowed values of an option, if they are listed.
[[nodiscard]] std::vector<std::string> listed_values(const CLI::Option& option);

}  // namespace proofmass::app
