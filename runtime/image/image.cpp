#include "runtime/image/image.h"

#include <algorithm>
#include <cmath>

namespace graftal {

float srgb_encoded(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

std::uint32_t level_of(float sample, int largest) {
    const float scaled = static_cast<float>(largest) * (sample > 0 ? std::min(sample, 1.0f) : 0.0f);
    const int below = static_cast<int>(scaled);
    return static_cast<std::uint32_t>(below + (scaled - static_cast<float>(below) >= 0.5f ? 1 : 0));
}

std::uint8_t level8_of(float sample) {
    return static_cast<std::uint8_t>(level_of(sample, 255));
}

} // namespace graftal
