#include "tests/property/nearest.h"

#include <algorithm>

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace graftal::testing {

double farthest_from(const std::vector<Vec3>& others, const std::vector<Vec3>& points) {
    using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
    std::vector<Point> tree_points;
    tree_points.reserve(others.size());
    for (const Vec3& p : others)
        tree_points.emplace_back(p.x, p.y, p.z);
    const boost::geometry::index::rtree<Point, boost::geometry::index::rstar<16>> tree(tree_points);
    double farthest = 0;
    for (const Vec3& p : points) {
        const Point from(p.x, p.y, p.z);
        for (auto it = tree.qbegin(boost::geometry::index::nearest(from, 1)); it != tree.qend(); ++it)
            farthest = std::max(farthest, boost::geometry::distance(from, *it));
    }
    return farthest;
}

} // namespace graftal::testing
