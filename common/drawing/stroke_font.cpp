#include "voxlist/drawing/stroke_font.h"

#include <cctype>
#include <map>
#include <string_view>

namespace voxlist::drawing {
namespace {

struct Drawing {
  char letter;
  // Pairs of digits are grid points x, y joined by strokes; a blank lifts the pen.
  std::string_view path;
};

constexpr Drawing kDrawings[] = {
    {'0', "103041453616050110"},
    {'1', "112026 1636"},
    {'2', "01103041420646"},
    {'3', "01103041423313 334445361605"},
    {'4', "300444 3036"},
    {'5', "400002324345361605"},
    {'6', "413010010516364544331304"},
    {'7', "004016"},
    {'8', "103041423313020110 1304051636454433"},
    {'9', "051636454130100102133342"},
    {'a', "12324346 441405163645"},
    {'b', "0006 0312324345361605"},
    {'c', "4332120305163645"},
    {'d', "4046 4332120305163645"},
    {'e', "04444332120305163645"},
    {'f', "40302126 0242"},
    {'g', "4332120305163645 4247381807"},
    {'h', "0006 0312324346"},
    {'i', "2226 2020"},
    {'j', "32372818 3030"},
    {'k', "0006 420446"},
    {'l', "202536"},
    {'m', "0206 03122326 23324346"},
    {'n', "0206 0312324346"},
    {'o', "123243453616050312"},
    {'p', "0208 0312324345361605"},
    {'q', "4248 4332120305163645"},
    {'r', "0206 03123243"},
    {'s', "43321203143445361605"},
    {'t', "1015263645 0232"},
    {'u', "0205163645 4246"},
    {'v', "022642"},
    {'w', "0216233642"},
    {'x', "0246 4206"},
    {'y', "0226 4218"},
    {'z', "02420646"},
    {'.', "2626"},
    {',', "2617"},
    {':', "2323 2626"},
    {'-', "0343"},
    {'+', "0343 2125"},
    {'=', "0242 0444"},
    {'/', "4006"},
    {'(', "30212536"},
    {')', "10212516"},
    {'%', "4006 1111 3535"},
    {'_', "0646"},
};

std::vector<GlyphStroke> strokes_of(std::string_view path) {
  std::vector<GlyphStroke> strokes;
  const auto point = [&](std::size_t i) {
    return Eigen::Vector2d(path[i] - '0', path[i + 1] - '0');
  };
  for (std::size_t i = 0; i + 3 < path.size(); i += 2) {
    if (path[i + 2] == ' ') {
      i += 1;  // and over the last point
    } else {
      strokes.push_back({point(i), point(i + 2)});
    }
  }
  return strokes;
}

}  // namespace

const std::vector<GlyphStroke>& glyph(char letter) {
  static const auto kGlyphs = [] {
    std::map<char, std::vector<GlyphStroke>> glyphs;
    for (const Drawing& drawing : kDrawings) {
      glyphs[drawing.letter] = strokes_of(drawing.path);
    }
    return glyphs;
  }();
  static const std::vector<GlyphStroke> kBlank;
  const auto found =
      kGlyphs.find(static_cast<char>(std::tolower(static_cast<unsigned char>(letter))));
  return found == kGlyphs.end() ? kBlank : found->second;
}

}  // namespace voxlist::drawing
