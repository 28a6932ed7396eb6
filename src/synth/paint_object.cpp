// Objects with lettering: screens, keyboards, books, posters, doors. OpenCV draws lines, boxes and
// letters.
#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "synth/hash_random.h"
#include "synth/paint.h"

namespace tessera {
namespace {

cv::Scalar Ink(Rgb8 c) { return cv::Scalar(c.r, c.g, c.b); }
cv::Scalar Ink(int r, int g, int b) { return cv::Scalar(r, g, b); }

// Wraps the image's pixels in a cv::Mat, without a copy.
cv::Mat Canvas(ColourImage& image) {
    return cv::Mat(image.height(), image.width(), CV_8UC3, image.data());
}

void Box(cv::Mat& canvas, double x, double y, double width, double height, const cv::Scalar& ink) {
    cv::rectangle(canvas, cv::Rect2d(x, y, std::max(width, 1.0), std::max(height, 1.0)), ink,
                  cv::FILLED);
}

// Draws text at most `width` by `height` pixels large; the top-left corner of its box is (x, y).
void Text(cv::Mat& canvas, const std::string& text, double x, double y, double width, double height,
          const cv::Scalar& ink) {
    const int face = cv::FONT_HERSHEY_DUPLEX;
    int baseline = 0;
    const cv::Size unit = cv::getTextSize(text, face, 1.0, 1, &baseline);
    const double scale = std::min(width / unit.width, height / unit.height);
    const int stroke = std::max(1, static_cast<int>(scale * 2.2));
    cv::putText(canvas, text, cv::Point2d(x, y + unit.height * scale), face, scale, ink, stroke,
                cv::LINE_AA);
}

// A stream of random numbers for one picture.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : key_(StreamKey(seed, 0xd1ce)) {}
    double Between(double low, double high) {
        return low + (high - low) * UniformFromBits(MixBits(key_ + count_++));
    }
    cv::Scalar Colour(double low, double high) {
        const double r = Between(low, high), g = Between(low, high), b = Between(low, high);
        return {r, g, b};
    }

  private:
    std::uint64_t key_, count_ = 0;
};

// Draws words as solid blocks.
void GreekText(cv::Mat& canvas, Dice& dice, cv::Rect2d area, double line_px,
               const std::vector<cv::Scalar>& inks) {
    for (double y = area.y; y + line_px < area.y + area.height; y += line_px * 1.7) {
        double x = area.x + line_px * 2 * static_cast<int>(dice.Between(0, 4));
        const double end = area.x + area.width * dice.Between(0.4, 1.0);
        while (x < end) {
            const double word = line_px * dice.Between(0.8, 5);
            const auto ink =
                static_cast<std::size_t>(dice.Between(0, static_cast<double>(inks.size())));
            Box(canvas, x, y, std::min(word, area.x + area.width - x), line_px, inks[ink]);
            x += word + line_px * 0.8;
        }
    }
}

}  // namespace

ColourImage PaintPoster(const std::string& caption, int width, int height, std::uint64_t seed) {
    Dice dice(seed);
    ColourImage image(width, height);
    cv::Mat canvas = Canvas(image);
    canvas = Ink(238, 234, 224);
    const double rim = 0.06 * width, w = width - 2 * rim, h = 0.76 * height;
    const cv::Scalar sky_top = dice.Colour(60, 200), sky_low = dice.Colour(150, 250);
    for (int y = 0; y < h; ++y) {
        const double t = y / h;
        Box(canvas, rim, rim + y, w, 1, sky_top * (1 - t) + sky_low * t);
    }
    cv::circle(canvas,
               cv::Point2d(rim + w * dice.Between(0.2, 0.8), rim + h * dice.Between(0.15, 0.4)),
               static_cast<int>(0.1 * width), dice.Colour(200, 255), cv::FILLED, cv::LINE_AA);
    for (int ridge = 0; ridge < 4; ++ridge) {
        const double base = rim + h * (0.45 + 0.15 * ridge);
        std::vector<cv::Point> outline = {cv::Point2d(rim, rim + h), cv::Point2d(rim, base)};
        for (int i = 1; i <= 7; ++i)
            outline.emplace_back(cv::Point2d(
                rim + w * i / 7, std::min(base - h * dice.Between(-0.08, 0.22), rim + h)));
        outline.emplace_back(cv::Point2d(rim + w, rim + h));
        cv::fillPoly(canvas, std::vector<std::vector<cv::Point>>{outline}, dice.Colour(20, 170),
                     cv::LINE_AA);
    }
    for (int block = 0; block < 6; ++block) {
        const double tower = h * dice.Between(0.08, 0.3);
        Box(canvas, rim + w * dice.Between(0, 0.9), rim + h - tower, w * dice.Between(0.04, 0.1),
            tower, dice.Colour(20, 240));
    }
    Text(canvas, caption, rim, rim + h + 0.05 * height, w, 0.07 * height, Ink(40, 40, 50));
    return image;
}

ColourImage PaintKeyboard(Rgb8 body, Rgb8 key, int width, int height, int rows) {
    ColourImage image(width, height, body);
    cv::Mat canvas = Canvas(image);
    const double margin = 0.05 * height, pitch = (height - 2 * margin) / rows;
    const std::string letters = "1234567890QWERTYUIOPASDFGHJKLZXCVBNM";
    std::size_t letter = 0;
    for (int row = 0; row < rows; ++row) {
        const bool last = row == rows - 1;
        double x = margin;
        for (int column = 0; x < width - margin - 0.4 * pitch; ++column) {
            double key_width = column == 0 ? pitch * (1.0 + 0.25 * row) : pitch;
            if (last && column == 3) key_width = pitch * 5.5;
            key_width = std::min(key_width, width - margin - x);
            const double y = margin + row * pitch;
            Box(canvas, x + 0.07 * pitch, y + 0.07 * pitch, key_width - 0.14 * pitch, 0.86 * pitch,
                Ink(key));
            Box(canvas, x + 0.14 * pitch, y + 0.10 * pitch, key_width - 0.28 * pitch, 0.70 * pitch,
                Ink(key) * 1.15 + cv::Scalar(8, 8, 8));
            if (!last && column > 0)
                Text(canvas, std::string(1, letters[letter++ % letters.size()]), x + 0.28 * pitch,
                     y + 0.22 * pitch, 0.4 * pitch, 0.36 * pitch,
                     key.r > 128 ? Ink(40, 40, 46) : Ink(225, 225, 230));
            x += key_width;
        }
    }
    return image;
}

ColourImage PaintScreen(int width, int height, std::uint64_t seed) {
    Dice dice(seed);
    ColourImage image(width, height, Rgb8{24, 24, 27});
    cv::Mat canvas = Canvas(image);
    const double rim = 0.025 * width, w = width - 2 * rim, h = height - 2.4 * rim;
    Box(canvas, rim, rim, w, h, Ink(38, 44, 58));
    Box(canvas, rim, rim, w, 0.05 * h, Ink(70, 96, 150));
    Text(canvas, "map.cpp - editor", rim + 0.02 * w, rim + 0.012 * h, 0.4 * w, 0.026 * h,
         Ink(235, 235, 240));
    Box(canvas, rim, rim + 0.05 * h, 0.17 * w, 0.95 * h, Ink(52, 58, 74));
    const std::vector<cv::Scalar> code = {Ink(220, 220, 225), Ink(130, 190, 250),
                                          Ink(240, 190, 110), Ink(150, 220, 140),
                                          Ink(230, 120, 130)};
    GreekText(canvas, dice, {rim + 0.015 * w, rim + 0.08 * h, 0.14 * w, 0.88 * h}, 0.018 * h,
              {Ink(170, 180, 200)});
    GreekText(canvas, dice, {rim + 0.19 * w, rim + 0.08 * h, 0.42 * w, 0.9 * h}, 0.018 * h, code);
    const cv::Rect2d plot(rim + 0.64 * w, rim + 0.08 * h, 0.34 * w, 0.42 * h);
    Box(canvas, plot.x, plot.y, plot.width, plot.height, Ink(245, 245, 240));
    for (int curve = 0; curve < 3; ++curve) {
        const cv::Scalar ink = dice.Colour(10, 210);
        cv::Point2d last(plot.x, plot.y + plot.height * dice.Between(0.3, 0.9));
        for (int i = 1; i <= 14; ++i) {
            const cv::Point2d next(plot.x + plot.width * i / 14,
                                   plot.y + plot.height * dice.Between(0.1, 0.95));
            cv::line(canvas, last, next, ink, std::max(1, height / 200), cv::LINE_AA);
            last = next;
        }
    }
    GreekText(canvas, dice, {plot.x, plot.y + plot.height + 0.04 * h, plot.width, 0.4 * h},
              0.02 * h, code);
    return image;
}

ColourImage PaintBookCover(const std::string& title, Rgb8 colour, int width, int height,
                           std::uint64_t seed) {
    Dice dice(seed);
    ColourImage image(width, height, colour);
    cv::Mat canvas = Canvas(image);
    Box(canvas, 0, 0.30 * height, width, 0.38 * height, dice.Colour(150, 250));
    for (int i = 0; i < 14; ++i)
        cv::circle(canvas,
                   cv::Point2d(width * dice.Between(0.05, 0.95), height * dice.Between(0.36, 0.62)),
                   static_cast<int>(width * dice.Between(0.02, 0.09)), dice.Colour(10, 240),
                   cv::FILLED, cv::LINE_AA);
    Text(canvas, title, 0.08 * width, 0.10 * height, 0.84 * width, 0.12 * height,
         Ink(250, 246, 230));
    Text(canvas, "second edition", 0.08 * width, 0.76 * height, 0.5 * width, 0.05 * height,
         Ink(250, 246, 230));
    cv::rectangle(canvas, cv::Rect2d(0.03 * width, 0.03 * height, 0.94 * width, 0.94 * height),
                  Ink(250, 246, 230), std::max(1, width / 120));
    return image;
}

ColourImage PaintBookSpine(const std::string& title, Rgb8 colour, int width, int height) {
    ColourImage image(width, height, colour);
    cv::Mat canvas = Canvas(image);
    Box(canvas, 0.06 * width, 0, 0.02 * width, height, Ink(235, 215, 150));
    Box(canvas, 0.92 * width, 0, 0.02 * width, height, Ink(235, 215, 150));
    Text(canvas, title, 0.14 * width, 0.25 * height, 0.7 * width, 0.5 * height, Ink(250, 246, 230));
    return image;
}

ColourImage PaintLeaves(int width, int height, std::uint64_t seed) {
    Dice dice(seed);
    ColourImage image(width, height);
    for (int y = 0; y < height; ++y) {
        const auto grey = static_cast<std::uint8_t>(dice.Between(185, 238));
        std::fill_n(image.row(y), width, Rgb8{grey, grey, static_cast<std::uint8_t>(grey - 20)});
    }
    return image;
}

ColourImage PaintPage(int width, int height, std::uint64_t seed) {
    Dice dice(seed);
    ColourImage image(width, height, Rgb8{243, 241, 232});
    cv::Mat canvas = Canvas(image);
    GreekText(canvas, dice, {0.1 * width, 0.08 * height, 0.8 * width, 0.84 * height},
              0.014 * height, {Ink(60, 60, 66), Ink(80, 80, 90)});
    return image;
}

ColourImage PaintMug(Rgb8 base, Rgb8 band, int size) {
    ColourImage image(size, size, base);
    cv::Mat canvas = Canvas(image);
    Box(canvas, 0, 0.12 * size, size, 0.08 * size, Ink(band));
    Box(canvas, 0, 0.80 * size, size, 0.08 * size, Ink(band));
    for (int i = 0; i < 4; ++i)
        cv::circle(canvas,
                   cv::Point2d(size * (0.125 + 0.25 * i), size * (i % 2 == 0 ? 0.40 : 0.60)),
                   size / 10, Ink(band), cv::FILLED, cv::LINE_AA);
    return image;
}

ColourImage PaintCoffee(Rgb8 rim, int size) {
    ColourImage image(size, size, rim);
    cv::Mat canvas = Canvas(image);
    cv::circle(canvas, cv::Point(size / 2, size / 2), static_cast<int>(0.44 * size),
               Ink(58, 36, 22), cv::FILLED, cv::LINE_AA);
    cv::circle(canvas, cv::Point(size * 2 / 5, size * 2 / 5), static_cast<int>(0.14 * size),
               Ink(96, 64, 40), cv::FILLED, cv::LINE_AA);
    return image;
}

ColourImage PaintDoor(Rgb8 colour, const std::string& plate, int width, int height) {
    ColourImage image = PaintWood(colour, 1, 512, 31);
    ColourImage door(width, height);
    cv::Mat canvas = Canvas(door);
    cv::resize(Canvas(image), canvas, canvas.size(), 0, 0, cv::INTER_LINEAR);
    for (const double y : {0.08, 0.52})
        cv::rectangle(canvas, cv::Rect2d(0.14 * width, y * height, 0.72 * width, 0.38 * height),
                      Ink(colour) * 0.6, std::max(1, width / 60));
    Box(canvas, 0.30 * width, 0.18 * height, 0.4 * width, 0.07 * height, Ink(240, 240, 236));
    Text(canvas, plate, 0.34 * width, 0.195 * height, 0.32 * width, 0.04 * height, Ink(20, 20, 30));
    Box(canvas, 0.86 * width, 0.50 * height, 0.08 * width, 0.03 * height, Ink(190, 190, 196));
    return door;
}

}  // namespace tessera
