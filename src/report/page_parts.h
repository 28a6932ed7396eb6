// Small pieces of the page: tables, sections, numbers with units. All text is escaped here. Pure
// functions, thread-safe.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tessera {

using TableRow = std::vector<std::string>;

// The first column is text, the others are numbers, to the right. `header` may be empty.
std::string TableHtml(const TableRow& header, const std::vector<TableRow>& rows);
// All columns are text.
std::string TextTableHtml(const TableRow& header, const std::vector<TableRow>& rows);

// A part of the page; `body` and `aside` are HTML. With an aside, the two stand beside each other
// on a wide screen.
std::string SectionHtml(const std::string& id, const std::string& title, const std::string& body,
                        const std::string& aside = {});
std::string ParagraphHtml(const std::string& text);

// "0.64 mm", "3.2 cm", "12.3 m": three digits.
std::string LengthText(double metres);
// "4.3 s", "12 min 5 s".
std::string DurationText(double seconds);
// "1,234,567".
std::string CountText(std::int64_t count);
std::string PercentText(double part, double whole);

}  // namespace tessera
