#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>

#include "tools/commands.hpp"

namespace {

enum ExitStatus { kBadData = 1, kBadUsage = 2 };

// One line on standard error, whatever the message holds.
int fail(const CLI::App& app, std::string message, ExitStatus status) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  const auto chosen = app.get_subcommands();
  fmt::print(stderr, "roundel{}{}: {}\n", chosen.empty() ? "" : " ",
             chosen.empty() ? "" : chosen.front()->get_name(), message);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Motion capture of circular markers with one camera.", "roundel");
  app.require_subcommand(1);
  roundel::add_markers(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help
      return app.exit(error);
    }
    return fail(app, error.what(), kBadUsage);
  } catch (const roundel::UsageError& error) {
    return fail(app, error.what(), kBadUsage);
  } catch (const std::exception& error) {
    return fail(app, error.what(), kBadData);
  }
  return 0;
}
