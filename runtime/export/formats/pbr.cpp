#include "runtime/export/formats/pbr.h"

#include <algorithm>
#include <cmath>

namespace graftal {

PbrMaterial pbr_of(const Material& material) {
    PbrMaterial pbr;
    const double exponent = 1 / std::max(material.roughness, 1e-4);
    double alpha = std::sqrt(2 / (exponent + 2));
    if (material.reflection > 0 || (material.is_transparent() && !material.is_veil())) alpha = material.blur;
    // A weak highlight is a wide one of the same light.
    const double shine =
        std::max({material.specular, material.reflection, material.is_veil() ? 0 : material.transparency});
    pbr.roughness =
        std::clamp(std::sqrt(alpha) * std::min(1.0, shine * 4) + std::max(0.0, 1 - shine * 4), 0.0, 1.0);
    pbr.metallic = std::clamp(material.metallic * std::min(1.0, material.reflection * 2), 0.0, 1.0);
    pbr.emission = material.emission;
    if (material.is_veil())
        pbr.opacity = 1 - material.transparency;
    else
        pbr.transmission = material.transparency;
    if (material.ior > 1) pbr.ior = material.ior;
    return pbr;
}

} // namespace graftal
