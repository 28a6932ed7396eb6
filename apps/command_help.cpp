// tessera help: the help of a command; and, for packages, a manual page and a completion made from
// the same texts.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "core/words.h"

namespace tessera {
namespace {

struct HelpArguments {
    std::string command;
    bool manual = false, completion = false;
};

// Text for troff: what begins with a dot or a quote would be a request.
std::string Troff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
        if (c == '\\') out += '\\';
        if (c == '-') out += '\\';
        out += c;
    }
    return out;
}

std::vector<const CLI::Option*> OptionsOf(const CLI::App& command) {
    return command.get_options([](const CLI::Option*) { return true; });
}
std::vector<const CLI::App*> CommandsOf(const CLI::App& app) {
    return app.get_subcommands(
        [](const CLI::App* command) { return !command->get_name().empty(); });
}

std::string OptionText(const CLI::Option& option) {
    const std::string type = option.get_type_size() == 0 ? "" : " " + option.get_type_name();
    return fmt::format(".TP\n.B {}\n{}\n", Troff(option.get_name(false, true) + type),
                       Troff(option.get_description()));
}

void AddCommand(const CLI::App& command, const std::string& name, std::string& page) {
    page += fmt::format(".SS {}\n{}\n", Troff(name), Troff(command.get_description()));
    for (const CLI::Option* option : OptionsOf(command)) page += OptionText(*option);
    for (const CLI::App* part : CommandsOf(command))
        AddCommand(*part, name + " " + part->get_name(), page);
}

std::string ManualPage(const CLI::App& app) {
    std::string page = fmt::format(
        ".TH TESSERA 1 \"\" \"{0}\"\n.SH NAME\ntessera \\- dense RGB\\-D SLAM\n.SH SYNOPSIS\n"
        ".B tessera\n.I COMMAND\n[options]\n.SH DESCRIPTION\n{1}\n.SH COMMANDS\n",
        app.version(), Troff(app.get_description()));
    for (const CLI::App* command : CommandsOf(app)) AddCommand(*command, command->get_name(), page);
    return page +
           ".SH SEE ALSO\n/usr/share/doc/tessera, of which docs/guide.md is the beginning.\n";
}

// The long options and the parts of a command, in one line.
std::string WordsOf(const CLI::App& command) {
    std::string words;
    for (const CLI::App* part : CommandsOf(command)) words += " " + part->get_name();
    for (const CLI::Option* option : OptionsOf(command))
        for (const std::string& name : option->get_lnames()) words += " --" + name;
    return words;
}

std::string Completion(const CLI::App& app) {
    std::string script =
        "# Completion of tessera for bash.\n_tessera() {\n    local words\n    case "
        "\"${COMP_WORDS[1]}\" "
        "in\n";
    for (const CLI::App* command : CommandsOf(app))
        script +=
            fmt::format("        {}) words=\"{}\" ;;\n", command->get_name(), WordsOf(*command));
    script += fmt::format(
        "        *) words=\"{}\" ;;\n    esac\n    [[ $COMP_CWORD -gt 1 ]] || words=\"{}\"\n"
        "    COMPREPLY=($(compgen -W \"$words\" -- \"${{COMP_WORDS[COMP_CWORD]}}\"))\n}}\n"
        "complete -o default -F _tessera tessera\n",
        WordsOf(app), WordsOf(app));
    return script;
}

int Help(const CLI::App& app, const HelpArguments& a) {
    if (a.manual || a.completion) {
        fmt::print("{}", a.manual ? ManualPage(app) : Completion(app));
        return kExitDone;
    }
    for (const CLI::App* command : CommandsOf(app))
        if (command->get_name() == a.command) {
            fmt::print("{}", command->help("tessera"));
            return kExitDone;
        }
    if (!a.command.empty()) return Fail(UnknownCommand(app, a.command));
    // app.help() would be that of this command.
    fmt::print("{}",
               app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
    return kExitDone;
}

}  // namespace

Status UnknownCommand(const CLI::App& app, const std::string& word) {
    constexpr std::size_t kMostEdits = 2;
    std::string nearest;
    std::size_t least = kMostEdits + 1;
    for (const CLI::App* command : CommandsOf(app))
        if (const std::size_t edits = EditDistance(word, command->get_name()); edits < least) {
            nearest = command->get_name();
            least = edits;
        }
    return Status::Error(fmt::format("unknown command or option '{}' ({}tessera -h lists them)",
                                     word,
                                     nearest.empty() ? "" : "did you mean " + nearest + "? "));
}

void AddHelpCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<HelpArguments>();
    CLI::App* command = app.add_subcommand("help", "Print the help of a command");
    command->add_option("COMMAND", a->command, "The command");
    command->add_flag("--manual", a->manual, "Print a manual page (troff) instead");
    command->add_flag("--completion", a->completion, "Print a completion for bash instead");
    command->callback([a, &app, &context] { context.exit_code = Help(app, *a); });
}

}  // namespace tessera
