#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "tools/commands.hpp"

namespace {

enum ExitStatus { kBadData = 1, kBadUsage = 2 };

std::string subcommand_names(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return names;
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  if (!app.get_subcommands().empty()) {
    return error.what();
  }
  const std::vector<std::string> rest = app.remaining();
  if (rest.empty()) {
    return "name a subcommand: " + subcommand_names(app);
  }
  return fmt::format("there is no {} {}; use {}", rest[0][0] == '-' ? "option" : "subcommand",
                     rest[0], subcommand_names(app));
}

// One line on standard error, whatever the message holds.
int fail(const CLI::App& app, std::string message, ExitStatus status) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  const auto chosen = app.get_subcommands();
  fmt::print(stderr, "roundel{}{}: {}\n", chosen.empty() ? "" : " ",
             chosen.empty() ? "" : chosen.front()->get_name(), message);
  return status;
}

int run(int argc, char** argv) {
  CLI::App app("Motion capture of circular markers with one camera.", "roundel");
  roundel::add_commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help
      return app.exit(error);
    }
    return fail(app, usage_message(app, error), kBadUsage);
  } catch (const roundel::UsageError& error) {
    return fail(app, error.what(), kBadUsage);
  } catch (const std::exception& error) {
    return fail(app, error.what(), kBadData);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (...) {  // not even the error could be told: out of memory
    std::fputs("roundel: out of memory\n", stderr);
    return kBadData;
  }
}
