#include "runtime/points/card.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr double margin = 1.02;
constexpr double thickness = 0.001; ///< of the width

double width_of(const Box& box, ImageSize size) {
    const double aspect = static_cast<double>(size.width) / size.height;
    return margin * std::max({box.size().x, box.size().y * aspect, 1e-100});
}

} // namespace

View card_view(const Box& box, ImageSize size) {
    View view;
    view.size = size;
    view.camera.orthographic = true;
    view.camera.width = width_of(box, size);
    view.camera.location = box.centre() + Vec3(0, 0, box.size().z + view.camera.width);
    return view;
}

std::string card_text(const std::string& picture, const Box& box, ImageSize size,
                      const std::vector<Material>& materials) {
    const double half = 0.5 * width_of(box, size);
    const Vec3 centre = box.centre();
    const Material finish = materials.size() == 1 ? materials.front() : Material();
    return fmt::format(
        "# A flat model's card: its picture is of random points (graftal points --card).\n"
        "material card {{ texture: \"{}\"  ambient: {}  diffuse: {}  specular: {}  roughness: {} }}\n\n"
        "object card {{\n"
        "    instance: cube  scale: {}, {}, {}  translate: {}, {}, {}  material: card\n"
        "}}\n",
        picture, shortest(finish.ambient), shortest(finish.diffuse), shortest(finish.specular),
        shortest(finish.roughness), shortest(half), shortest(half * size.height / size.width),
        shortest(half * thickness), shortest(centre.x), shortest(centre.y), shortest(centre.z));
}

bool is_card_picture(const std::string& picture) {
    return std::ranges::all_of(picture,
                               [](unsigned char c) { return c >= ' ' && c != '"' && c != '\\' && c != 127; });
}

} // namespace graftal
