#include "core/config.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "core/words.h"

namespace tessera {
namespace {

std::string Join(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : " | ") + name;
    return text;
}

// Parses the whole text as one number; nullopt if anything else is in it.
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
        return Status::Error(fmt::format("{}: '{}' is not {} (allowed: {})", key,
                                         Printable(text, kQuotedBytes), kind, allowed));
    if (*number < range.minimum || *number > range.maximum)
        return Status::Error(
            fmt::format("{}: {} is out of range (allowed: {})", key, text, allowed));
    value = *number;
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
    AddParameter({key, unit, allowed, documentation, "",
                  [&value] { return fmt::format("{}", value); },
                  [=, &value, full = prefix_ + key](const std::string& text) {
                      return SetNumber(full, value, range, allowed, text);
                  }});
}

void ConfigParameters::Add(const std::string& key, int& value, Range range, const std::string& unit,
                           const std::string& documentation) {
    const std::string allowed = fmt::format("[{}, {}]", range.minimum, range.maximum);
    AddParameter({key, unit, allowed, documentation, "",
                  [&value] { return fmt::format("{}", value); },
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
                          return Status::Error(fmt::format("{}: '{}' is neither true nor false",
                                                           full, Printable(text, kQuotedBytes)));
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
                  },
                  true});
}

void ConfigParameters::AddChoiceByName(const std::string& key,
                                       const std::vector<std::string>& names,
                                       std::function<std::string()> get,
                                       std::function<void(const std::string&)> set,
                                       const std::string& documentation) {
    AddParameter({key, "", Join(names), documentation, "", std::move(get),
                  [=, full = prefix_ + key](const std::string& text) {
                      if (std::find(names.begin(), names.end(), text) == names.end())
                          return Status::Error(fmt::format("{}: '{}' is not one of {}", full,
                                                           Printable(text, kQuotedBytes),
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
        // Weigh the last part of the key extra, so that a key with the wrong section or none still
        // finds its match.
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
        return Status::Error(fmt::format("unknown configuration key '{}'; did you mean '{}'?", key,
                                         NearestKey(key)));
    return parameter->set(value);
}

}  // namespace tessera
