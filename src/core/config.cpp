#include "core/config.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace tessera {
namespace {

std::string Join(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : " | ") + name;
    return text;
}

// The number that makes up the whole text, or nothing.
template <class Number>
std::optional<Number> ParseNumber(const std::string& text) {
    Number number{};
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end) return std::nullopt;
    return number;
}

template <class Number>
Status SetNumber(const std::string& key, Number& value, ConfigParameters::Range range,
                 const std::string& allowed, const std::string& text) {
    const auto number = ParseNumber<Number>(text);
    const char* kind = std::is_integral_v<Number> ? "a whole number" : "a number";
    if (!number || !std::isfinite(static_cast<double>(*number)))
        return Status::Error(fmt::format("{}: '{}' is not {} (allowed: {})", key, text, kind, allowed));
    if (*number < range.minimum || *number > range.maximum)
        return Status::Error(fmt::format("{}: {} is out of range (allowed: {})", key, text, allowed));
    value = *number;
    return Status::Ok();
}

std::size_t EditDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitute = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
        }
    }
    return row[b.size()];
}

// Dotted key and scalar text of every leaf; depth-limited, because the file is a user's.
Status Flatten(const YAML::Node& node, const std::string& prefix, int depth,
               std::vector<std::pair<std::string, std::string>>& leaves) {
    if (depth > 8) return Status::Error(prefix + ": nested too deeply");
    for (const auto& entry : node) {
        const std::string key = prefix + (prefix.empty() ? "" : ".") + entry.first.as<std::string>();
        if (entry.second.IsMap()) {
            if (Status status = Flatten(entry.second, key, depth + 1, leaves); !status.ok())
                return status;
        } else if (entry.second.IsScalar()) {
            leaves.emplace_back(key, entry.second.as<std::string>());
        } else {
            return Status::Error(key + ": needs a single value");
        }
    }
    return Status::Ok();
}

}  // namespace

void ConfigParameters::Section(const std::string& name,
                               const std::function<void(ConfigParameters&)>& describe) {
    const std::string outer = prefix_;
    prefix_ += name + ".";
    describe(*this);
    prefix_ = outer;
}

void ConfigParameters::AddParameter(Parameter parameter) {
    parameter.key = prefix_ + parameter.key;
    TESSERA_CHECK(Find(parameter.key) == nullptr, "{} is described twice", parameter.key);
    parameter.default_value = parameter.get();
    parameters_.push_back(std::move(parameter));
}

void ConfigParameters::Add(const std::string& key, double& value, Range range,
                           const std::string& unit, const std::string& documentation) {
    const std::string allowed = fmt::format("[{}, {}]", range.minimum, range.maximum);
    AddParameter({key, unit, allowed, documentation, "", [&value] { return fmt::format("{}", value); },
                  [=, &value, full = prefix_ + key](const std::string& text) {
                      return SetNumber(full, value, range, allowed, text);
                  }});
}

void ConfigParameters::Add(const std::string& key, int& value, Range range, const std::string& unit,
                           const std::string& documentation) {
    const std::string allowed = fmt::format("[{}, {}]", range.minimum, range.maximum);
    AddParameter({key, unit, allowed, documentation, "", [&value] { return fmt::format("{}", value); },
                  [=, &value, full = prefix_ + key](const std::string& text) {
                      return SetNumber(full, value, range, allowed, text);
                  }});
}

void ConfigParameters::Add(const std::string& key, bool& value, const std::string& documentation) {
    AddParameter({key, "", "true or false", documentation, "",
                  [&value] { return value ? "true" : "false"; },
                  [&value, full = prefix_ + key](const std::string& text) {
                      const bool yes = text == "true" || text == "on" || text == "yes";
                      const bool no = text == "false" || text == "off" || text == "no";
                      if (!yes && !no)
                          return Status::Error(
                              fmt::format("{}: '{}' is neither true nor false", full, text));
                      value = yes;
                      return Status::Ok();
                  }});
}

void ConfigParameters::Add(const std::string& key, std::string& value,
                           const std::string& documentation) {
    AddParameter({key, "", "text", documentation, "", [&value] { return value; },
                  [&value](const std::string& text) {
                      value = text;
                      return Status::Ok();
                  }});
}

void ConfigParameters::AddChoiceByName(const std::string& key,
                                       const std::vector<std::string>& names,
                                       std::function<std::string()> get,
                                       std::function<void(const std::string&)> set,
                                       const std::string& documentation) {
    AddParameter({key, "", Join(names), documentation, "", std::move(get),
                  [=, full = prefix_ + key](const std::string& text) {
                      if (std::find(names.begin(), names.end(), text) == names.end())
                          return Status::Error(fmt::format("{}: '{}' is none of {}", full, text,
                                                           Join(names)));
                      set(text);
                      return Status::Ok();
                  }});
}

ConfigParameters::Parameter* ConfigParameters::Find(const std::string& key) {
    const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                    [&](const Parameter& p) { return p.key == key; });
    return found == parameters_.end() ? nullptr : &*found;
}

std::string ConfigParameters::NearestKey(const std::string& key) const {
    std::string nearest;
    std::size_t best = std::numeric_limits<std::size_t>::max();
    for (const Parameter& parameter : parameters_) {
        // A wrong section or a bare last part must still find its key.
        const std::string leaf = parameter.key.substr(parameter.key.rfind('.') + 1);
        const std::string key_leaf = key.substr(key.rfind('.') + 1);
        const std::size_t distance =
            EditDistance(key, parameter.key) + 2 * EditDistance(key_leaf, leaf);
        if (distance < best) {
            best = distance;
            nearest = parameter.key;
        }
    }
    return nearest;
}

Status ConfigParameters::Set(const std::string& key, const std::string& value) {
    Parameter* parameter = Find(key);
    if (parameter == nullptr)
        return Status::Error(
            fmt::format("unknown configuration key '{}'; did you mean '{}'?", key, NearestKey(key)));
    return parameter->set(value);
}

Status ConfigParameters::LoadYaml(const std::string& yaml, const std::string& name) {
    std::vector<std::pair<std::string, std::string>> leaves;
    try {
        const YAML::Node root = YAML::Load(yaml);
        if (root.IsNull()) return Status::Ok();
        if (!root.IsMap()) return Status::Error(name + ": expected 'key: value' lines");
        if (Status status = Flatten(root, "", 0, leaves); !status.ok())
            return Status::Error(name + ": " + status.message());
    } catch (const YAML::Exception& error) {
        return Status::Error(fmt::format("{}: not valid YAML: {}", name, error.what()));
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
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    if (!file) return Status::Error(path + ": cannot be read");
    return LoadYaml(text.str(), path);
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
                (value.empty() ? "\"\"" : value) + "\n";
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
            markdown += fmt::format("\n## {}\n\n| key | default | unit | allowed | what it does, when to "
                                    "change it |\n| --- | --- | --- | --- | --- |\n",
                                    here.empty() ? "general" : here);
        }
        std::string allowed = parameter.allowed;
        for (std::size_t at = 0; (at = allowed.find(" | ", at)) != std::string::npos;)
            allowed.replace(at, 3, ", ");
        markdown += fmt::format("| `{}` | {} | {} | {} | {} |\n", parameter.key.substr(dot + 1),
                                parameter.default_value, parameter.unit, allowed,
                                parameter.documentation);
    }
    return markdown;
}

}  // namespace tessera
