#include "plan/dxf.h"

#include <fmt/format.h>

#include <numbers>

namespace tessera {
namespace {

template <class T>
void Put(std::string& text, int code, const T& value) {
    fmt::format_to(std::back_inserter(text), "{:>3}\n{}\n", code, value);
}

void PutNumber(std::string& text, int code, double value) {
    fmt::format_to(std::back_inserter(text), "{:>3}\n{:.6f}\n", code, value);
}

// Line breaks would end a value; other control characters are no text either.
std::string OneLine(const std::string& text) {
    std::string line;
    for (const char c : text) line += static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
    return line;
}

// One UTF-8 character from `at`; invalid bytes stand for themselves.
char32_t NextCharacter(const std::string& text, std::size_t& at) {
    const auto first = static_cast<unsigned char>(text[at++]);
    const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
    char32_t code = more == 0 ? first : first & (0x3fU >> more);
    for (int k = 0; k < more && at < text.size(); ++k) {
        const auto byte = static_cast<unsigned char>(text[at]);
        if ((byte & 0xc0U) != 0x80U) break;
        code = code << 6 | (byte & 0x3fU);
        ++at;
    }
    return code;
}

std::string Encoded(const std::string& text) {
    std::string encoded;
    for (std::size_t at = 0; at < text.size();) {
        const char32_t code = NextCharacter(text, at);
        if (code < 128)
            encoded += static_cast<char>(code);
        else
            encoded += fmt::format("\\U+{:04X}", static_cast<std::uint32_t>(code));
    }
    return encoded;
}

}  // namespace

DxfDrawing::DxfDrawing(const std::vector<std::pair<std::string, int>>& layers,
                       const std::string& comment) {
    Put(head_, 999, Encoded(OneLine(comment)));
    std::string& tables = entities_;  // they come first
    Put(tables, 0, "SECTION");
    Put(tables, 2, "TABLES");
    Put(tables, 0, "TABLE");
    Put(tables, 2, "LTYPE");
    Put(tables, 70, 1);
    for (const auto& [code, value] : {std::pair{0, "LTYPE"},
                                      {2, "CONTINUOUS"},
                                      {70, "0"},
                                      {3, "Solid line"},
                                      {72, "65"},
                                      {73, "0"},
                                      {40, "0.0"}})
        Put(tables, code, value);
    Put(tables, 0, "ENDTAB");
    Put(tables, 0, "TABLE");
    Put(tables, 2, "LAYER");
    Put(tables, 70, layers.size());
    for (const auto& [name, colour] : layers) {
        Put(tables, 0, "LAYER");
        Put(tables, 2, name);
        Put(tables, 70, 0);
        Put(tables, 62, colour);
        Put(tables, 6, "CONTINUOUS");
    }
    for (const auto& [code, value] :
         {std::pair{0, "ENDTAB"}, {0, "ENDSEC"}, {0, "SECTION"}, {2, "ENTITIES"}})
        Put(tables, code, value);
}

void DxfDrawing::Entity(const char* type, const std::string& layer) {
    Put(entities_, 0, type);
    Put(entities_, 8, layer);
}

void DxfDrawing::Point(const Eigen::Vector2d& p, int code) {
    PutNumber(entities_, code, p.x());
    PutNumber(entities_, code + 10, p.y());
    PutNumber(entities_, code + 20, 0);
    low_ = empty_ ? p : low_.cwiseMin(p);
    high_ = empty_ ? p : high_.cwiseMax(p);
    empty_ = false;
}

void DxfDrawing::Line(const std::string& layer, const Eigen::Vector2d& from,
                      const Eigen::Vector2d& to) {
    Entity("LINE", layer);
    Point(from);
    Point(to, 11);
}

void DxfDrawing::Polyline(const std::string& layer, const Polygon2d& points, bool closed) {
    if (points.size() < 2) return;
    Entity("POLYLINE", layer);
    Put(entities_, 66, 1);  // vertices follow
    for (const int code : {10, 20, 30}) PutNumber(entities_, code, 0);
    Put(entities_, 70, closed ? 1 : 0);
    for (const Eigen::Vector2d& p : points) {
        Entity("VERTEX", layer);
        Point(p);
    }
    Entity("SEQEND", layer);
}

void DxfDrawing::Text(const std::string& layer, const Eigen::Vector2d& at, double height,
                      const std::string& text, double angle_rad) {
    Entity("TEXT", layer);
    Point(at);
    PutNumber(entities_, 40, height);
    Put(entities_, 1, Encoded(OneLine(text)));
    PutNumber(entities_, 50, angle_rad * 180 / std::numbers::pi);
    Put(entities_, 72, 1);  // centred
    Point(at, 11);
    Put(entities_, 73, 2);  // middle
}

std::string DxfDrawing::Finish() const {
    std::string text = head_;
    Put(text, 0, "SECTION");
    Put(text, 2, "HEADER");
    Put(text, 9, "$ACADVER");
    Put(text, 1, "AC1009");
    for (const auto& [name, corner] : {std::pair{"$EXTMIN", low_}, {"$EXTMAX", high_}}) {
        Put(text, 9, name);
        PutNumber(text, 10, corner.x());
        PutNumber(text, 20, corner.y());
        PutNumber(text, 30, 0);
    }
    Put(text, 9, "$LUNITS");
    Put(text, 70, 2);  // decimal
    Put(text, 0, "ENDSEC");
    text += entities_;
    Put(text, 0, "ENDSEC");
    Put(text, 0, "EOF");
    return text;
}

}  // namespace tessera
