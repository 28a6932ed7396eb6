// Configuration as text: YAML input and output, and the tables of docs/configuration.md.
#include <yaml-cpp/yaml.h>

#include <set>
#include <sstream>

#include "core/config.h"
#include "core/input_file.h"

namespace tessera {
namespace {

// Collects the dotted key and scalar text of every leaf. The file comes from the user, so this
// limits the depth and the number of nodes visited (YAML aliases can multiply them).
Status Flatten(const YAML::Node& node, const std::string& prefix, int depth, int& visits_left,
               std::vector<std::pair<std::string, std::string>>& leaves) {
    if (depth > 8) return Status::Error(prefix + ": nested too deeply");
    std::set<std::string> seen;
    for (const auto& entry : node) {
        if (--visits_left < 0) return Status::Error(prefix + ": too many entries");
        if (!entry.first.IsScalar()) return Status::Error(prefix + ": a key is not a word");
        const std::string key =
            prefix + (prefix.empty() ? "" : ".") + Printable(entry.first.Scalar(), kQuotedBytes);
        if (!seen.insert(key).second) return Status::Error(key + ": is given twice");
        if (entry.second.IsMap()) {
            if (Status status = Flatten(entry.second, key, depth + 1, visits_left, leaves);
                !status.ok())
                return status;
        } else if (entry.second.IsScalar()) {
            leaves.emplace_back(key, entry.second.as<std::string>());
        } else {
            return Status::Error(key + ": needs a single value");
        }
    }
    return Status::Ok();
}

// A YAML double-quoted scalar.
std::string Quoted(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        else
            quoted += c;
    }
    return quoted + '"';
}

}  // namespace

Status ConfigParameters::LoadYaml(const std::string& yaml, const std::string& name) {
    std::vector<std::pair<std::string, std::string>> leaves;
    int visits_left = 10000;
    try {
        const YAML::Node root = YAML::Load(yaml);
        if (root.IsNull()) return Status::Ok();
        if (!root.IsMap()) return Status::Error(name + ": expected 'key: value' lines");
        if (Status status = Flatten(root, "", 0, visits_left, leaves); !status.ok())
            return Status::Error(name + ": " + status.message());
    } catch (const YAML::Exception& error) {
        return Status::Error(
            fmt::format("{}: not valid YAML: {}", name, Printable(error.what(), 200)));
    }
    std::vector<std::string> before;
    for (const Parameter& parameter : parameters_) before.push_back(parameter.get());
    for (const auto& [key, value] : leaves) {
        if (Status status = Set(key, value); !status.ok()) {
            for (std::size_t i = 0; i < before.size(); ++i) (void)parameters_[i].set(before[i]);
            return Status::Error(name + ": " + status.message());
        }
    }
    return Status::Ok();
}

Status ConfigParameters::LoadYamlFile(const std::string& path) {
    constexpr std::size_t kMostBytes = 1 << 20;
    const Result<std::string> text = ReadWholeFile(path, kMostBytes);
    return text.ok() ? LoadYaml(text.value(), path) : text.status();
}

std::string ConfigParameters::ToYaml() const {
    std::string yaml;
    std::vector<std::string> open;  // sections that the last line was in
    for (const Parameter& parameter : parameters_) {
        std::vector<std::string> parts;
        std::stringstream stream(parameter.key);
        for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
        std::size_t common = 0;
        while (common < open.size() && common + 1 < parts.size() && open[common] == parts[common])
            ++common;
        for (std::size_t i = common; i + 1 < parts.size(); ++i)
            yaml += std::string(2 * i, ' ') + parts[i] + ":\n";
        open.assign(parts.begin(), parts.end() - 1);
        const std::string value = parameter.get();
        yaml += std::string(2 * (parts.size() - 1), ' ') + parts.back() + ": " +
                (parameter.is_text ? Quoted(value) : value) + "\n";
    }
    return yaml;
}

std::string ConfigParameters::ToMarkdown() const {
    std::string markdown, section = "?";
    for (const Parameter& parameter : parameters_) {
        const auto dot = parameter.key.rfind('.');
        const std::string here = dot == std::string::npos ? "" : parameter.key.substr(0, dot);
        if (here != section) {
            section = here;
            markdown += fmt::format(
                "\n## {}\n\n| key | default | unit | allowed | what it does, when to "
                "change it |\n| --- | --- | --- | --- | --- |\n",
                here.empty() ? "general" : here);
        }
        std::string allowed = parameter.allowed;
        for (std::size_t at = 0; (at = allowed.find(" | ", at)) != std::string::npos;)
            allowed.replace(at, 3, ", ");
        markdown +=
            fmt::format("| `{}` | {} | {} | {} | {} |\n", parameter.key.substr(dot + 1),
                        parameter.default_value, parameter.unit, allowed, parameter.documentation);
    }
    return markdown;
}

}  // namespace tessera
