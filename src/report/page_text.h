// Text and bytes from outside, made safe to stand in a page of HTML. Pure functions, thread-safe.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera {

// Text for an element or a quoted attribute. Bytes that are no valid or no visible text become
// "\xNN".
std::string EscapeHtml(std::string_view text);

// JSON that can stand in a script element: it holds no '<', '>' or '&' any more, so nothing in it
// ends the element, and means the same.
std::string EscapeScriptJson(std::string_view json);

std::string Base64(std::span<const std::uint8_t> bytes);

// Replaces each {{name}} of a template. Values are not searched again, so they may contain braces.
// A name without a value is a bug.
std::string FillTemplate(std::string_view text,
                         const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace tessera
