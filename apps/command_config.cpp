// tessera config: prints the parameters, as a YAML file to start from or as the table of
// docs/configuration.md.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "config_options.h"
#include "system/run_config.h"

namespace tessera {
namespace {

struct ConfigArguments {
    ConfigOptions config;
    bool markdown = false;
};

int PrintConfig(const ConfigArguments& a) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    if (Status status = a.config.Apply(parameters); !status.ok()) return Fail(status);
    if (Status status = config.Validate(); !status.ok()) return Fail(status);
    fmt::print("{}", a.markdown ? ConfigurationDocument() : parameters.ToYaml());
    return kExitDone;
}

}  // namespace

void AddConfigCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<ConfigArguments>();
    CLI::App* command =
        app.add_subcommand("config", "Print the whole configuration as YAML, or check a file");
    a->config.AddTo(*command);
    command->add_flag("--markdown", a->markdown,
                      "Print a table of all parameters with units, ranges and defaults");
    command->callback([a, &context] { context.exit_code = PrintConfig(*a); });
}

}  // namespace tessera
