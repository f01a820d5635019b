#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>

#include "compiler/analysis/contraction.h"

namespace graftal {

namespace {

constexpr std::uint64_t max_products = 5'000'000;
constexpr double certifiable_rate = 1 - 1e-11;

Eigen::Matrix3d eigen(const Mat3& m) {
    Eigen::Matrix3d result;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            result(row, column) = m[column][row];
    return result;
}

double largest_stretch(const Eigen::Matrix3d& m) {
    const Eigen::Matrix3d gram = m.transpose() * m;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(gram, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

/// Depth first over the paths from one object, each only as far as its first prefix that shrinks enough.
class Walker {
  public:
    Walker(const Graph& graph, const Components& components, const ContractionCertificate& certificate)
        : graph_(graph), components_(components), certificate_(certificate) {}

    bool all_shrink_from(ObjectId start) {
        path_.assign(
            1, {start, 0, eigen(certificate_.metric[start]), 0, std::abs(certificate_.log_weight[start])});
        while (!path_.empty()) {
            Step& step = path_.back();
            const std::vector<Instance>& instances = graph_.objects[step.object].instances;
            if (step.next_instance == instances.size()) {
                path_.pop_back();
                continue;
            }
            const Instance& instance = instances[step.next_instance++];
            if (components_.component_of[instance.master] != components_.component_of[start]) continue;
            if (++products_ > max_products) return false;
            Step next{instance.master, 0, step.product * eigen(instance.parent_from_child.linear),
                      step.log_scale, step.log_weight_sum};
            next.log_weight_sum =
                std::max(next.log_weight_sum, std::abs(certificate_.log_weight[next.object]));
            if (!rescale(next)) continue;
            if (shrinks(start, next)) continue;
            if (path_.size() >= static_cast<std::size_t>(certificate_.depth)) return false;
            path_.push_back(next);
        }
        return true;
    }

  private:
    struct Step {
        ObjectId object;
        std::size_t next_instance;
        Eigen::Matrix3d product; // of the metric at the start and the linear parts, times exp(-log_scale)
        double log_scale;
        double log_weight_sum;
    };

    /// False if the product vanishes: then every longer one does.
    static bool rescale(Step& step) {
        const double size = step.product.cwiseAbs().maxCoeff();
        if (!(size > 0)) return false;
        step.product /= size;
        step.log_scale += std::log(size);
        return true;
    }

    bool shrinks(ObjectId start, const Step& step) const {
        const Eigen::Matrix3d metric = eigen(certificate_.metric[step.object]);
        const Eigen::Matrix3d inverse = metric.inverse();
        const double length = static_cast<double>(path_.size());
        // Rounding of the product, of the inverse and of the logs, generously.
        const double rounding =
            1e-15 * (length + metric.norm() * inverse.norm()) * step.product.norm() * inverse.norm();
        const double stretch = largest_stretch(step.product * inverse) + rounding;
        const double log_stretch = std::log(stretch) + step.log_scale + certificate_.log_weight[step.object] -
                                   certificate_.log_weight[start];
        const double log_rounding = 1e-15 * (length + step.log_weight_sum + std::abs(step.log_scale));
        return log_stretch + log_rounding <= length * std::log(certificate_.rate);
    }

    const Graph& graph_;
    const Components& components_;
    const ContractionCertificate& certificate_;
    std::vector<Step> path_;
    std::uint64_t products_ = 0;
};

bool usable(const Graph& graph, const ContractionCertificate& certificate) {
    if (certificate.metric.size() != graph.objects.size()) return false;
    if (certificate.log_weight.size() != graph.objects.size()) return false;
    for (std::size_t v = 0; v < graph.objects.size(); ++v) {
        if (!std::isfinite(certificate.log_weight[v])) return false;
        const Mat3& l = certificate.metric[v];
        for (int i = 0; i < 3; ++i)
            if (!(l[i][i] > 0) || !std::isfinite(l[i][i])) return false;
    }
    return certificate.rate > 0 && certificate.rate <= certifiable_rate && certificate.depth >= 1;
}

} // namespace

bool certificate_holds(const Graph& graph, const Components& components,
                       const ContractionCertificate& certificate) {
    if (!usable(graph, certificate)) return false;
    Walker walker(graph, components, certificate);
    for (ObjectId id = 0; id < graph.objects.size(); ++id)
        if (components.cyclic[components.component_of[id]] && !walker.all_shrink_from(id)) return false;
    return true;
}

} // namespace graftal
