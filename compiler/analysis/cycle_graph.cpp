#include "compiler/analysis/cycle_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace graftal {

std::vector<std::uint32_t> places_in_components(const Components& components) {
    std::vector<std::uint32_t> places(components.component_of.size());
    for (const std::vector<ObjectId>& members : components.members)
        for (std::uint32_t i = 0; i < members.size(); ++i)
            places[members[i]] = i;
    return places;
}

CycleGraph cycle_graph(const Graph& graph, const Components& components,
                       const std::vector<std::uint32_t>& places, std::uint32_t component) {
    CycleGraph cycle;
    cycle.graph = &graph;
    cycle.objects = components.members[component];
    cycle.first.push_back(0);
    for (const ObjectId id : cycle.objects) {
        const std::vector<Instance>& instances = graph.objects[id].instances;
        for (std::uint32_t i = 0; i < instances.size(); ++i)
            if (components.component_of[instances[i].master] == component)
                cycle.edges.push_back({places[id], places[instances[i].master], {id, i}});
        cycle.first.push_back(static_cast<std::uint32_t>(cycle.edges.size()));
    }
    return cycle;
}

double similarity_ratio(const Mat3& linear) {
    const double size = largest_entry(linear);
    if (!(size > 0)) return -1;
    const Vec3 sigma = singular_values(linear * (1 / size));
    if (sigma.x - sigma.z > 1e-9 * sigma.x) return -1;
    return size * std::cbrt(sigma.x * sigma.y * sigma.z);
}

double spectral_radius(const Mat3& linear) {
    Eigen::Matrix3d matrix;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            matrix(row, column) = linear[column][row];
    return Eigen::EigenSolver<Eigen::Matrix3d>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

double log_spectral_radius(const CycleGraph& cycle, std::span<const std::uint32_t> walk) {
    double log_scale = 0;
    bool similarities = true;
    Mat3 product(1.0);
    for (const std::uint32_t e : walk) {
        const Mat3& linear = cycle.transform(cycle.edges[e]).linear;
        const double ratio = similarities ? similarity_ratio(linear) : -1;
        if (ratio > 0) {
            product = product * (1 / ratio) * linear;
            log_scale += std::log(ratio);
            continue;
        }
        similarities = false;
        product = product * linear;
        const double size = largest_entry(product);
        if (!(size > 0)) return -std::numeric_limits<double>::infinity();
        product *= 1 / size;
        log_scale += std::log(size);
    }
    if (similarities) return log_scale;
    return log_scale + std::log(spectral_radius(product));
}

} // namespace graftal
