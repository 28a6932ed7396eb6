#include "config_options.h"

#include <CLI/CLI.hpp>

#include "system/run_config.h"

namespace tessera {

void ConfigOptions::AddTo(CLI::App& command) {
    std::string names;
    for (const Preset& preset : Presets()) names += (names.empty() ? "" : ", ") + preset.name;
    command.add_option("--config", config, "Preset (" + names + ") or YAML file")
        ->type_name("NAME|FILE");
    command
        .add_option("--set", sets,
                    "Set one key of the configuration (tessera config lists them); repeatable")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

Status ConfigOptions::Apply(ConfigParameters& parameters) const {
    if (!config.empty())
        if (Status status = LoadPresetOrFile(config, parameters); !status.ok()) return status;
    for (const std::string& set : sets) {
        const auto equals = set.find('=');
        if (equals == std::string::npos)
            return Status::Error(fmt::format("--set {}: expected KEY=VALUE", set));
        if (Status status = parameters.Set(set.substr(0, equals), set.substr(equals + 1));
            !status.ok())
            return status;
    }
    return Status::Ok();
}

}  // namespace tessera
