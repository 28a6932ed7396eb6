// Configuration. Every class has a Config struct. Its defaults, units, ranges and help texts are
// defined once, in Describe(ConfigParameters&). That description drives the YAML reader, --set, the
// file saved with each result and docs/configuration.md. An unknown key is an error that names the
// nearest known key.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/status.h"

namespace tessera {

// Holds references to the members of the described structs, which must outlive it. Owner thread
// only.
class ConfigParameters {
  public:
    struct Parameter {
        std::string key;            // dotted: "mapping.voxel_size_m"
        std::string unit;           // "m", "rad", "" ...
        std::string allowed;        // "[0.001, 1]", "true or false", "a | b | c"
        std::string documentation;  // what it does and when to change it
        std::string default_value;  // value at the time of Add
        std::function<std::string()> get;
        std::function<Status(const std::string&)> set;
        bool is_text = false;  // written in quotes in YAML
    };
    struct Range {
        double minimum, maximum;  // both inclusive
    };

    // Keys added inside `describe` get the prefix "name.".
    void Section(const std::string& name, const std::function<void(ConfigParameters&)>& describe);

    void Add(const std::string& key, double& value, Range range, const std::string& unit,
             const std::string& documentation);
    void Add(const std::string& key, int& value, Range range, const std::string& unit,
             const std::string& documentation);
    void Add(const std::string& key, bool& value, const std::string& documentation);
    void Add(const std::string& key, std::string& value, const std::string& documentation);
    template <class Enum>
    void AddChoice(const std::string& key, Enum& value,
                   const std::vector<std::pair<std::string, Enum>>& choices,
                   const std::string& documentation) {
        std::vector<std::string> names;
        for (const auto& choice : choices) names.push_back(choice.first);
        AddChoiceByName(
            key, names,
            [&value, choices] {
                for (const auto& [name, candidate] : choices)
                    if (candidate == value) return name;
                return std::string("?");
            },
            [&value, choices](const std::string& text) {
                for (const auto& [name, candidate] : choices)
                    if (name == text) value = candidate;
            },
            documentation);
    }

    const std::vector<Parameter>& parameters() const { return parameters_; }

    // Sets one key from text, as --set KEY=VALUE does.
    Status Set(const std::string& key, const std::string& value);
    // Sets every key in a YAML text. `name` is the file name used in messages. On error, nothing
    // changes.
    Status LoadYaml(const std::string& yaml, const std::string& name);
    Status LoadYamlFile(const std::string& path);
    // All keys with their current values.
    std::string ToYaml() const;
    // One Markdown table per section: key, default, unit, allowed values, documentation.
    std::string ToMarkdown() const;

  private:
    void AddParameter(Parameter parameter);
    void AddChoiceByName(const std::string& key, const std::vector<std::string>& names,
                         std::function<std::string()> get,
                         std::function<void(const std::string&)> set,
                         const std::string& documentation);
    Parameter* Find(const std::string& key);
    std::string NearestKey(const std::string& key) const;

    std::string prefix_;
    std::vector<Parameter> parameters_;
};

}  // namespace tessera
