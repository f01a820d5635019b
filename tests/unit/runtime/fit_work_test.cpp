#include "runtime/fit/fit_work.h"

#include <cmath>
#include <functional>
#include <new>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "compiler/detail/work.h"
#include "compiler/primitives/mesh_file.h"
#include "runtime/system/worker_threads.h"
#include "runtime/trace/picture_tracer.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

class FitWork : public testing::Test {
  protected:
    /// What fits where a model with an error of less than so many pixels takes too much memory.
    FittedModel fitted(double too_fine_px, const DetailOptions& options) {
        return fitted(test::tetrahedron(), options, [&](double error_px) { return error_px < too_fine_px; });
    }

    /// `too_large`: whether a model with such an error takes too much memory.
    FittedModel fitted(const Graph& graph, const DetailOptions& options,
                       const std::function<bool(double)>& too_large) {
        const Components components = strong_components(graph);
        const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
        view_.camera.location = Vec3(0, 0, 5);
        PreparedGraph made = prepare_graph(graph, components, bounds, options.preparing());
        made.work_seconds = spent_seconds_;
        const auto prepared = std::make_shared<const PreparedGraph>(std::move(made));
        const auto limits = [&](const TraceModel& model) {
            if (model.options.error_px != tried_px_) ++tries_;
            tried_px_ = model.options.error_px;
            if (too_large(model.options.error_px)) throw std::bad_alloc();
            return ShaderLimits();
        };
        const WorkerThreads workers(threads_);
        return *fit_work({.prepared = prepared,
                          .view = view_,
                          .options = options,
                          .textures = {},
                          .wanted = wanted_,
                          .limits_of = limits,
                          .workers = &workers,
                          .cancelled = [] { return false; },
                          .on_first_look = on_first_look_});
    }

    /// Cubes of all sizes that lie in each other.
    static Graph crowd() {
        Graph graph;
        const ObjectId cube = graph.primitive(PrimitiveKind::cube);
        const auto self = static_cast<ObjectId>(graph.objects.size());
        Object crowd{"crowd", {}, {}, {}, {}};
        crowd.instances.push_back({cube, Affine::scale(Vec3(.3)), {}, {}, {}});
        for (int i = 0; i < 8; ++i) {
            const Vec3 corner(i & 1 ? .3 : -.3, i & 2 ? .3 : -.3, i & 4 ? .3 : -.3);
            crowd.instances.push_back(
                {self, Affine::translate(corner) * Affine::scale(Vec3(.7)), {}, {}, {}});
        }
        graph.root = graph.add(std::move(crowd));
        return graph;
    }

    /// Frames of cubes within each other: every ray meets all of them, and hits none.
    static Graph inner_cubes() {
        Graph graph;
        const ObjectId cube = graph.primitive(PrimitiveKind::cube);
        ObjectId inner = cube;
        for (int level = 0; level < 6; ++level) {
            Object object{"level" + std::to_string(level), {}, {}, {}, {}};
            for (int i = 0; i < 12; ++i) {
                const double turn = 0.5236 * i;
                object.instances.push_back(
                    {inner,
                     Affine::translate({0.9 * std::cos(turn), 0.9 * std::sin(turn), 0}) *
                         Affine::scale(Vec3(.6)),
                     {},
                     {},
                     {}});
            }
            inner = graph.add(std::move(object));
        }
        graph.root = inner;
        return graph;
    }

    View view_{.size = {64, 48}};
    Sampling wanted_;
    int threads_ = 1;
    double spent_seconds_ = 0; ///< by the stages before
    std::function<void(const TraceModel&, double)> on_first_look_;
    int tries_ = 0; ///< models of different errors, one after the other
    double tried_px_ = 0;
};

TEST_F(FitWork, KeepsWhatFits) {
    const DetailOptions options;
    const FittedModel model = fitted(0, options);
    EXPECT_EQ(model.error_px, options.error_px);
    EXPECT_FALSE(model.out_of_memory);
    EXPECT_FALSE(model.rays_cut);
    EXPECT_EQ(model.sampling, wanted_);
    EXPECT_EQ(model.seconds, model.whole_seconds);
}

TEST_F(FitWork, ShowsTheFirstModelOnceAndComesToTheSame) {
    for (const double work_seconds : {100.0, 1e-3}) {
        DetailOptions options;
        options.work_seconds = work_seconds;
        on_first_look_ = {};
        const FittedModel alone = fitted(0, options);
        int looks = 0;
        on_first_look_ = [&](const TraceModel& model, double seconds) {
            ++looks;
            EXPECT_EQ(model.options.error_px, options.error_px);
            EXPECT_GT(seconds, 0);
            Image picture{64, 48, 3, std::vector<float>(64 * 48 * 3)};
            EXPECT_TRUE(PictureTracer(model).trace({.block = 8}, {}, picture));
        };
        const FittedModel model = fitted(0, options);
        EXPECT_EQ(looks, 1);
        EXPECT_EQ(model.seconds, alone.seconds);
        EXPECT_EQ(model.tried_seconds, alone.tried_seconds);
        EXPECT_EQ(model.error_px, alone.error_px);
        EXPECT_EQ(model.sampling, alone.sampling);
    }
}

TEST_F(FitWork, CoarsensWhatTakesTooMuchMemory) {
    const DetailOptions options;
    const FittedModel model = fitted(1, options);
    EXPECT_EQ(model.error_px, 1.5 * 1.5 * 1.5 * options.error_px);
    EXPECT_EQ(model.model->options.error_px, model.error_px);
    EXPECT_TRUE(model.out_of_memory);
    EXPECT_EQ(tries_, 2);
    EXPECT_THROW(fitted(1000, options), std::bad_alloc);
    EXPECT_EQ(tries_, 7);
}

TEST_F(FitWork, CoarsensWhatTakesTooMuchWorkAndThenTooMuchMemory) {
    DetailOptions options;
    options.work_seconds = 1e-2;
    const FittedModel model = fitted(crowd(), options, [&](double error_px) {
        return error_px > options.error_px && error_px < 4 * options.error_px;
    });
    EXPECT_TRUE(model.out_of_memory);
    EXPECT_GE(model.error_px, 4 * options.error_px);
}

/// Where copies lie in each other does not depend on the error: tries that are coarser need not ask again.
TEST_F(FitWork, LooksOnceForCrowds) {
    DetailOptions options;
    const auto fits = [](double) { return false; };
    const FittedModel first = fitted(crowd(), options, fits);
    ASSERT_EQ(first.error_px, options.error_px);
    EXPECT_TRUE(first.model->has_shells);
    EXPECT_GT(first.model->weighed, 0u);
    options.work_seconds = 1e-3;
    const FittedModel coarser = fitted(crowd(), options, fits);
    ASSERT_GT(coarser.error_px, options.error_px);
    EXPECT_TRUE(coarser.model->has_shells);
    EXPECT_EQ(coarser.model->weighed, 0u);
}

// One ray through thousands of cubes takes longer than the whole picture may.
// A look that was given up went on to make every shell that its rays met, for minutes.
TEST_F(FitWork, NoShellIsMadeBeyondTheWorkForThem) {
    FittedModel crowded = fitted(crowd(), DetailOptions(), [](double) { return false; });
    MeshStore& meshes = crowded.model->meshes;
    ASSERT_GT(meshes.shell_work(), 0u);
    const std::uint64_t before = meshes.shell_work();
    const PieceKind key = meshes.key(crowded.model->prepared.cut.root, {}, unlimited_steps, 7);
    meshes.make_until(before - 1);
    EXPECT_TRUE(meshes.mesh(key, {}).corners.empty());
    EXPECT_EQ(meshes.shell_work(), before);
    meshes.make_until(UINT64_MAX);
    EXPECT_FALSE(meshes.mesh(key, {}).corners.empty());
}

TEST_F(FitWork, LooksNoLongerThanItMay) {
    DetailOptions options;
    options.error_px = 0.05;
    options.steps = 6; // where levels end nothing becomes a shell
    options.work_seconds = 0.1;
    const FittedModel model = fitted(inner_cubes(), options, [](double) { return false; });
    EXPECT_LT(model.seconds, model.whole_seconds);
    EXPECT_LT(model.tried_seconds, options.work_seconds);
}

// A look at a poster took a share of all its work: a plan of 36 million pixels, a minute.
TEST_F(FitWork, LooksNoLongerAtAPoster) {
    view_.size = {20'000, 20'000};
    DetailOptions options;
    options.steps = 6;
    options.work_seconds = 1e5;
    const FittedModel model = fitted(inner_cubes(), options, [](double) { return false; });
    EXPECT_LT(model.tried_seconds, 2);
    EXPECT_LT(model.seconds, options.work_seconds);
}

// Rays went through all of a mesh, whatever they had left: 200,000 spikes took twelve seconds of one allowed.
TEST_F(FitWork, RaysGiveWayInMeshes) {
    std::mt19937 generator(5);
    const auto number = [&] { return static_cast<double>(generator()) / 2147483648.0 - 1; };
    MeshData spikes;
    for (std::uint32_t i = 0; i < 4'000; ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const double x = number(), y = number();
            spikes.vertices.emplace_back(x, y, number());
        }
        spikes.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    Graph graph;
    Object object{"spikes", {}, {}, {}, {}};
    object.instances.push_back({graph.primitive(mesh_primitive("spikes", spikes)), Affine(), {}, {}, {}});
    graph.root = graph.add(std::move(object));
    DetailOptions options;
    options.work_seconds = 0.02;
    const FittedModel model = fitted(graph, options, [](double) { return false; });
    EXPECT_TRUE(model.rays_cut);
    EXPECT_LE(model.seconds, options.work_seconds);
    EXPECT_LE(model.tried_seconds, options.work_seconds);
    PictureTracer tracer(*model.model);
    ASSERT_TRUE(tracer.probe(0, 64 * 48, {}));
    const double seconds = static_cast<double>(tracer.statistics().work) / WorkRates::ray_steps;
    EXPECT_LE(seconds * model.sampling.samples_a_pixel(), 1.5 * options.work_seconds);
}

// A part that is looked at in the world took as much as ten others, and counted as none: sixteen rays of a
// look spent eleven times what it may.
TEST_F(FitWork, RaysGiveWayAmongFlatParts) {
    Graph graph = inner_cubes();
    Object flat{"flat", {}, {}, {}, {}};
    Affine crush;
    crush.linear = Mat3(Vec3(1, 0, 0.3), Vec3(0, 1, 0.2), Vec3(0, 0, 0));
    flat.instances.push_back({graph.root, crush, {}, {}, {}});
    graph.root = graph.add(std::move(flat));
    DetailOptions options;
    options.error_px = 0.001;
    options.work_seconds = 0.3;
    const FittedModel model = fitted(graph, options, [](double) { return false; });
    EXPECT_TRUE(model.rays_cut);
    EXPECT_LE(model.tried_seconds, options.work_seconds);
}

// A tower of a few pixels' width among an empty picture was never met by a look, and took a quarter of an
// hour.
TEST_F(FitWork, SeesWhatIsThin) {
    Graph graph = inner_cubes();
    Object thin{"thin", {}, {}, {}, {}};
    const Affine to_a_side = Affine::translate({0.37, 0, 0}) * Affine::scale({0.005, 1, 0.005});
    thin.instances.push_back({graph.root, to_a_side, {}, {}, {}});
    graph.root = graph.add(std::move(thin));
    view_.size = {320, 240};
    DetailOptions options;
    options.error_px = 0.01;
    options.steps = 6;
    const FittedModel model = fitted(graph, options, [](double) { return false; });
    ASSERT_EQ(model.error_px, options.error_px);
    PictureTracer tracer(*model.model);
    ASSERT_TRUE(tracer.probe(0, 320 * 240, {}));
    const double seconds = static_cast<double>(tracer.statistics().work) / WorkRates::ray_steps;
    EXPECT_GT(model.seconds, seconds / 1.5);
    EXPECT_LT(model.seconds, seconds * 1.5);
}

// A forest of a hundred thousand trees was drawn by balls of 19 pixels, with four samples for each.
TEST_F(FitWork, SamplesGoBeforePartsGrowLarge) {
    DetailOptions options;
    options.error_px = 0.05;
    options.steps = 6;
    const auto fits = [](double) { return false; };
    view_.size = {320, 240};
    wanted_ = {.most_samples = 16};
    const double whole_seconds = fitted(inner_cubes(), options, fits).whole_seconds;
    options.work_seconds = whole_seconds / 2;
    const FittedModel sparse = fitted(inner_cubes(), options, fits);
    EXPECT_EQ(sparse.error_px, options.error_px);
    EXPECT_LT(sparse.sampling.most_samples, 16);
    EXPECT_GE(sparse.sampling.most_samples, 4);
    EXPECT_FALSE(sparse.rays_cut);
    EXPECT_LE(sparse.seconds + sparse.tried_seconds, options.work_seconds);
}

// 3 seconds in place of 5.6 turned 0.5 pixels into 19.22: rays of a first look that were given up counted as
// if they would have taken all the work that there is.
TEST_F(FitWork, LessWorkHasNoCliffs) {
    DetailOptions options;
    options.steps = 6;
    options.error_px = 0.05;
    view_.size = {160, 120};
    wanted_ = {.most_samples = 64};
    const auto fits = [](double) { return false; };
    const double whole_seconds = fitted(inner_cubes(), options, fits).whole_seconds;
    double last_error_px = options.error_px, last_samples = 64;
    for (double share = 1.5; share > 0.01; share *= 0.6) {
        options.work_seconds = share * whole_seconds;
        const FittedModel model = fitted(inner_cubes(), options, fits);
        const double samples = model.sampling.samples_a_pixel();
        EXPECT_FALSE(model.rays_cut) << share;
        EXPECT_LE(model.error_px, 2.5 * last_error_px) << share;
        EXPECT_GE(samples, last_samples / 4.001) << share;
        EXPECT_LE(model.seconds + model.tried_seconds, 1.2 * options.work_seconds) << share;
        last_error_px = std::max(model.error_px, options.error_px);
        last_samples = samples;
    }
}

// Where the work held too few samples to denoise, but enough without the denoiser's own price, no sampling
// fitted: the pound sign came 28.8 px coarse at two seconds, and 0.5 px at one.
TEST_F(FitWork, ThePriceOfTheDenoiserMakesNoCliff) {
    wanted_ = {.most_samples = 64, .denoise = true};
    view_.size = {640, 360};
    DetailOptions options;
    for (double work_seconds = 4; work_seconds > 0.2; work_seconds *= 0.85) {
        options.work_seconds = work_seconds;
        const FittedModel model = fitted(0, options);
        EXPECT_LE(model.error_px, 2 * options.error_px) << work_seconds;
        EXPECT_LE(model.seconds + model.tried_seconds, 1.2 * work_seconds) << work_seconds;
    }
}

TEST_F(FitWork, ThreadsDecideNothing) {
    wanted_ = {.most_samples = 64};
    for (const double work_seconds : {1e-1, 1e-2}) {
        DetailOptions options;
        options.work_seconds = work_seconds;
        const auto fits = [](double) { return false; };
        threads_ = 1;
        const FittedModel one = fitted(crowd(), options, fits);
        threads_ = 3;
        const FittedModel three = fitted(crowd(), options, fits);
        EXPECT_EQ(one.error_px, three.error_px);
        EXPECT_EQ(one.sampling, three.sampling);
        EXPECT_EQ(one.seconds, three.seconds);
    }
}

/// One account: what the stages before took is subtracted, down to half for tries and rays.
TEST_F(FitWork, WhatStagesTookIsNotLeftForThePicture) {
    wanted_ = {.most_samples = 256};
    DetailOptions options;
    options.work_seconds = 1e6;
    const double whole_seconds = fitted(0, options).whole_seconds;
    options.work_seconds = 1.5 * whole_seconds;
    std::vector<double> samples;
    for (const double spent : {0.0, 0.6, 0.75, 100.0}) {
        spent_seconds_ = spent * whole_seconds;
        const FittedModel model = fitted(0, options);
        EXPECT_LE(model.seconds, 1.2 * std::max(1.5 - spent, 0.75) * whole_seconds) << spent;
        samples.push_back(model.sampling.samples_a_pixel());
    }
    EXPECT_EQ(samples[0], 256);
    EXPECT_LT(samples[1], samples[0]);
    EXPECT_LT(samples[2], samples[1]);
    EXPECT_EQ(samples[3], samples[2]) << "both leave half or less";
}

/// What does not depend on the error is found once, whatever is tried.
TEST_F(FitWork, TriesShareTheirGround) {
    DetailOptions options;
    options.work_seconds = 1e-3;
    std::shared_ptr<TraceBasis> basis;
    on_first_look_ = [&](const TraceModel& model, double) { basis = model.basis; };
    const FittedModel model = fitted(crowd(), options, [](double) { return false; });
    EXPECT_GT(model.error_px, options.error_px);
    EXPECT_EQ(model.model->basis, basis);
}

TEST_F(FitWork, LargeGraphsAreSlower) {
    EXPECT_EQ(slowness_of_graph(0), 1);
    EXPECT_EQ(slowness_of_graph(200'000), 1);
    EXPECT_NEAR(slowness_of_graph(1'600'000), 2.2, 1e-9);
}

TEST_F(FitWork, CoarsensNothingOfWhichNothingIsLeftOut) {
    DetailOptions options;
    options.error_px = 0;
    options.steps = 3;
    EXPECT_NO_THROW(fitted(0, options));
    EXPECT_THROW(fitted(1, options), std::bad_alloc);
}

} // namespace
} // namespace graftal
