#include "compiler/support/ray.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(Ray, IsParametrisedByMultiplesOfItsDirection) {
    const Ray ray{{1, 2, 3}, {0, 0, -2}};
    EXPECT_EQ(ray(1.5), Vec3(1, 2, 0));
}

} // namespace
} // namespace graftal
