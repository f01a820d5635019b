#include "compiler/lsys/compose/composer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/lsys/derive/word.h"
#include "compiler/support/id_table.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Most rules of one kind that may follow each other without a step between them.
constexpr unsigned most_repeated = 1000;

/// A triangle of a skin takes as much work as so many instances.
constexpr std::size_t instances_a_triangle = 4;
/// So many vertices of open polygons, which each part around copies, take as much work as an instance.
constexpr std::size_t vertices_an_instance = 32;

/// Most tries, in all, of productions that wait for their time: some seconds of work.
constexpr std::uint64_t most_waits = 10'000'000;

double angle_between(Vec3 a, Vec3 b) {
    return 2 * std::asin(std::min(1.0, 0.5 * glm::length(a - b)));
}

void place_piece(Turtle& turtle, ModuleId piece, const TurtlePart& part, Span span, double snap) {
    if (!FoldedWord::is_branch(piece)) return turtle.append(part, span, {.snap = snap});
    turtle.open_branch();
    turtle.append_branch(part, span, {.snap = snap});
    turtle.close_branch();
}

} // namespace

Mat3 chord_frame(Vec3 exit) {
    const double length = glm::length(exit);
    if (!(length > 0) || std::abs(exit.z) > 1e-9 * length) return Mat3(1.0);
    const Vec3 y = glm::normalize(Vec3(exit.x, exit.y, 0));
    return Mat3(Vec3(y.y, -y.x, 0), y, Vec3(0, 0, 1));
}

LsysComposer::LsysComposer(LsysRewriter& rewriter, TurtleContext& turtle, ObjectPool& pool,
                           const ModelPlacer& models, Variants variants, const LsysLimits& limits)
    : rewriter_(rewriter), context_(turtle), pool_(pool), models_(models), variants_(variants),
      max_parts_(limits.max_parts), give_up_from_(limits.give_up_from), refuse_from_(limits.refuse_from),
      stop_from_(limits.stop_from), max_bytes_(limits.max_bytes), snaps_(limits.snap_angle > 0),
      sizes_(limits.sizes), size_step_(limits.size_step), steps_unit_(limits.steps_unit),
      directions_(std::max(limits.snap_angle, DirectionTable::rounding)),
      uses_directions_(rewriter.grammar().uses({TurtleCommand::level, TurtleCommand::tropism,
                                                TurtleCommand::set_tropism, TurtleCommand::bend_down})),
      decomposes_(rewriter.grammar().has_rules(RuleKind::decompose)),
      is_timed_(rewriter.grammar().draws_in_time()) {
    for (SymbolId symbol = 0; symbol < rewriter.grammar().symbols.size(); ++symbol)
        rewritten_.push_back(rewriter.grammar().is_rewritten(symbol));
}

std::optional<TurtlePart> LsysComposer::compose(unsigned steps, const TurtleState& start, double share) {
    steps_ = steps;
    share_ = share;
    if (!rewriter_.prepare(steps)) return std::nullopt;
    const std::optional<ModuleString> axiom = rewriter_.axiom();
    if (!axiom) return std::nullopt;
    return run_from({.start = start,
                     .string = *axiom,
                     .string_stage = stage_before(steps),
                     .span = rewriter_.grammar().source->axiom->span,
                     .turtle = Turtle(context_, start)});
}

std::optional<TurtlePart> LsysComposer::compose_word(const FoldedWord& word, unsigned steps,
                                                     const TurtleState& start, double share) {
    word_ = &word;
    steps_ = steps;
    share_ = share;
    return run_from({.start = start,
                     .string = word.trunk(),
                     .string_stage = 0,
                     .span = rewriter_.grammar().source->axiom->span,
                     .turtle = Turtle(context_, start)});
}

std::optional<TurtlePart> LsysComposer::run_from(Task first) {
    tasks_.clear();
    tasks_.push_back(std::move(first));
    if (!run_tasks()) return std::nullopt;
    Task& whole = tasks_.back();
    if (context_.skin > 0) whole.turtle.end_limbs();
    if (context_.skin > 0 && !whole.turtle.within_limits(whole.span)) return std::nullopt;
    TurtlePart part = std::move(whole.turtle).finish();
    if (context_.skin > 0)
        count_work(part);
    else if (const std::size_t work = new_polygon_work(); work > 0)
        rewriter_.work_of_part(work);
    tasks_.pop_back();
    return part;
}

/// Until the first task is done.
bool LsysComposer::run_tasks() {
    while (true) {
        const std::size_t depth = tasks_.size();
        if (!advance(tasks_.back())) return false;
        if (tasks_.size() > depth) continue;
        if (depth == 1) return true;
        if (FoldedWord::is_piece(tasks_.back().module))
            complete_piece();
        else if (!complete_task())
            return false;
        if (!tasks_.back().turtle.within_limits(tasks_.back().span)) return false;
    }
}

LsysComposer::Stage LsysComposer::stage_before(unsigned steps) const {
    return 2 * steps + (decomposes_ ? 1 : 0);
}

/// The modules of a derived word say when they came into being, where that matters; others came with their
/// string, or are what a module is drawn as, and as old as that.
std::uint32_t LsysComposer::birth_of(ModuleId module, const Task& task) const {
    const std::uint32_t birth = rewriter_.modules().birth(module);
    return birth == ModuleTable::no_birth ? task.birth : birth;
}

/// The number of a stage for chance. In a film of growth the same module must draw the same after one step
/// more, so that there steps are counted from the beginning.
std::uint32_t LsysComposer::chance_stage(Stage stage, bool drawing) const {
    if (!is_timed_) return stage;
    return drawing ? 0 : 2 * steps_ + 2 - stage;
}

/// The number of a module for chance: in a film ids of modules are not the same after one step more.
std::uint32_t LsysComposer::chance_module(ModuleId module) const {
    const ModuleTable& modules = rewriter_.modules();
    if (!is_timed_ || FoldedWord::is_piece(module)) return module;
    std::uint64_t hash = modules.symbol(module);
    for (const double parameter : modules.parameters(module)) // equal up to rounding
        hash = mixed(hash, std::bit_cast<std::uint32_t>(static_cast<float>(parameter)));
    return static_cast<std::uint32_t>(mixed(hash, 1) >> 32);
}

/// False after an error.
bool LsysComposer::choose(RuleKind kind, ModuleId module, Stage stage, std::uint32_t birth,
                          std::uint32_t variant, Unfolded& result) {
    Moment moment = moment_of(steps_ - stage / 2 + (kind == RuleKind::produce ? 1 : 0), birth);
    if (kind == RuleKind::interpret) moment = {moment.step + share_, moment.age + share_};
    if (!rewriter_.is_rewritten(kind, module, moment)) return true;
    const std::vector<Alternative>* alternatives = rewriter_.alternatives(kind, module, moment);
    if (!alternatives) return false;
    const Winner<Alternative> chosen = variants_.choose(*alternatives, variant, chance_module(module),
                                                        chance_stage(stage, kind == RuleKind::interpret));
    result.by = chosen.entrant;
    result.draw = chosen.even();
    result.kind = kind;
    result.moment = moment;
    result.random = alternatives->size() > 1 || chosen.entrant->rule->draws > 0;
    return true;
}

/// Rewrites by a step or a decomposition, at this stage or, if productions read the time, at a later one.
bool LsysComposer::rewrite(ModuleId module, Stage stage, std::uint32_t birth, std::uint32_t variant,
                           Unfolded& result) {
    const LsysGrammar& grammar = rewriter_.grammar();
    const SymbolId symbol = rewriter_.modules().symbol(module);
    const bool waits =
        (grammar.time(RuleKind::produce, symbol) | grammar.time(RuleKind::decompose, symbol)) != 0;
    const std::uint64_t key = (std::uint64_t{module} << 32) | stage;
    if (waits)
        if (const auto known = fits_at_.find(key); known != fits_at_.end()) stage = known->second;
    while (stage > 0) {
        if (waits && ++waits_ > most_waits) return refuse_to_wait(symbol);
        const bool decomposing = stage % 2 == 1;
        result.stage = decomposing ? stage : stage_before(stage / 2 - 1);
        if (!choose(decomposing ? RuleKind::decompose : RuleKind::produce, module, stage, birth, variant,
                    result))
            return false;
        if (result.by) break;
        if (decomposing)
            --stage;
        else // a module that no production fits now, none will fit later, unless time decides
            stage = waits ? result.stage : 0;
    }
    if (waits) fits_at_.emplace(key, stage);
    return true;
}

bool LsysComposer::refuse_to_wait(SymbolId symbol) {
    const LsysGrammar& grammar = rewriter_.grammar();
    const RuleKind kind =
        grammar.time(RuleKind::produce, symbol) != 0 ? RuleKind::produce : RuleKind::decompose;
    context_.diagnostics
        .error(grammar.rules[grammar.candidates(kind, symbol).front()].source->span,
               fmt::format("the productions of '{}' must handle too many different modules",
                           grammar.symbols[symbol]))
        .with_hint("use fewer steps, or modules with fewer different parameters");
    return false;
}

bool LsysComposer::unfold(ModuleId module, Stage stage, std::uint32_t birth, std::uint32_t variant,
                          Unfolded& result) {
    result = {};
    if (!rewrite(module, stage, birth, variant, result)) return false;
    if (result.by) return true;
    result.stage = 0;
    result.aged =
        rewriter_.grammar().time(RuleKind::interpret, rewriter_.modules().symbol(module)) & reads_age;
    return choose(RuleKind::interpret, module, 0, birth, variant, result);
}

/// Goes on until the string ends, or a part is missing, whose task is then the last.
bool LsysComposer::advance(Task& task) {
    if (witness_) witness_->enter(task.frame);
    for (; task.at < task.string.size() && !task.turtle.finished(); ++task.at) {
        const ModuleId module = task.string[task.at];
        rewriter_.work();
        if (FoldedWord::is_piece(module)) {
            if (!draw_piece(task, module)) return true;
            continue;
        }
        const std::uint32_t variant =
            variants_.child(task.start.variant, chance_module(task.module),
                            chance_stage(task.string_stage, task.interprets), task.at);
        const std::uint32_t birth = birth_of(module, task);
        const bool absolute = sizes_ && task.rule && sizes_->is_absolute(*task.rule, task.at);
        if (!rewritten_[rewriter_.modules().symbol(module)] || task.turtle.passing_over()) {
            if (!draw(task, module, absolute, birth)) return false;
            continue;
        }
        Lookup found{.module = module, .state = {}, .placing = {}};
        if (sizes_ && !resize(found, task, absolute)) return false;
        Unfolded unfolded;
        if (!unfold(found.module, task.string_stage, birth, variant, unfolded)) return false;
        if (unfolded.aged) task.turtle.read_birth();
        if (!unfolded.by) {
            if (!draw(task, module, absolute, birth)) return false;
            continue;
        }
        if (!sizes_) found.state = state_of(task.turtle, found.placing.snap);
        const Stage stage = unfolded.kind == RuleKind::interpret ? 0 : task.string_stage;
        found.state.variant = variant;
        found.state.birth = birth;
        if (unfolded.kind == RuleKind::interpret && !begins_interpretation(task, module, absolute, birth))
            return false;
        const TurtlePart* part = known_part(found.module, stage, found.state);
        if (!part) return start_task(found, stage, unfolded);
        if (stage > 0) ++served_;
        if (!append(task, *part, found.placing, unfolded.kind == RuleKind::interpret)) return false;
        if (!task.turtle.within_limits(task.span)) return false;
    }
    return true;
}

/// The part where it is composed already; null if it is not, or if a witness hears of each place.
const TurtlePart* LsysComposer::known_part(ModuleId module, Stage stage, const TurtleState& state) const {
    return witness_ && !sums_ ? nullptr : parts_.find(module, stage, state);
}

/// Places a part, of which a witness has heard, or hears now. False where that ends it.
bool LsysComposer::append(Task& parent, const TurtlePart& part, const Placing& placing, bool interprets) {
    if (witness_) witness_->enter(parent.frame);
    if (sums_ && !witness_->places(part.sums, placing.scale * parent.turtle.scale())) return false;
    parent.turtle.append(part, parent.span, placing);
    if (witness_ && interprets && !parent.interprets) witness_->ends(parent.turtle);
    return true;
}

/// False if its part is missing, whose task is then the last.
bool LsysComposer::draw_piece(Task& task, ModuleId piece) {
    double snap = 0;
    const bool is_branch = FoldedWord::is_branch(piece);
    if (witness_ && task.turtle.passing_over()) return ++task.at, true;
    if (is_branch) task.turtle.open_branch();
    TurtleState state = state_of(task.turtle, snap);
    if (is_branch) task.turtle.close_branch();
    state.variant = variants_.child(task.start.variant, task.module, 0, task.at);
    if (const TurtlePart* part = known_part(piece, 0, state)) {
        place_piece(task.turtle, piece, *part, task.span, snap);
        return true;
    }
    if (witness_ && is_branch) witness_->opens_branch();
    tasks_.push_back({.module = piece,
                      .start = state,
                      .string = word_->piece(piece),
                      .span = task.span,
                      .turtle = Turtle(context_, state),
                      .frame = frame_of_child({})});
    return false;
}

/// Makes exits equal that differ by rounding only.
void LsysComposer::clean_exit(TurtlePart& part) {
    Mat3& exit = part.start_from_exit.linear;
    if (part.mirrors) exit[0] = -exit[0];
    exit = rotations_.representative(exit);
    if (part.mirrors) exit[0] = -exit[0];
    if (part.writes & reads_second) part.exit.second = rotations_.representative(part.exit.second);
    part.exit_scale = sizes_known_.representative(part.exit_scale);
}

/// Work of a part that is composed, and of the skins of its limbs and its polygons.
void LsysComposer::count_work(const TurtlePart& part) {
    const std::size_t before = std::exchange(skin_triangles_, context_.bodies.skin_triangles());
    const std::size_t made = skin_triangles_ - before;
    rewriter_.work_of_part(part.instances.size() + part.limb_node_count() + instances_a_triangle * made +
                           part.vertex_count() / vertices_an_instance + new_polygon_work());
}

/// Work of the polygons that have been closed since it was asked for last.
std::size_t LsysComposer::new_polygon_work() {
    const std::size_t before = std::exchange(polygon_work_, context_.bodies.polygon_work());
    return polygon_work_ - before;
}

/// Places the last task, which has come to its end, in the one before.
void LsysComposer::complete_piece() {
    Task task = std::move(tasks_.back());
    tasks_.pop_back();
    Task& parent = tasks_.back();
    const bool is_branch = FoldedWord::is_branch(task.module);
    TurtlePart part = std::move(task.turtle).finish();
    clean_exit(part);
    count_work(part);
    if (witness_) {
        witness_->enter(parent.frame);
        place_piece(parent.turtle, task.module, part, parent.span, 0);
        if (is_branch) witness_->closes_branch();
        ++parent.at;
        return;
    }
    if (is_branch) part.modules += 2;
    std::optional<Instance> line = line_for(part, task);
    part.instances =
        pool_.share(std::move(part.instances), std::move(line), is_branch ? "branch" : "run", task.span);
    place_piece(parent.turtle, task.module, part, parent.span, 0);
    ++parent.at;
    // Pieces must leave room for other parts; they can be drawn again.
    if (parts_.size() < max_parts_ / 2) parts_.add(task.module, 0, task.start, std::move(part));
}

/// The line that is drawn in place of a part too small to see.
std::optional<Instance> LsysComposer::line_for(const TurtlePart& part, const Task& task) {
    if (!context_.lines || part.has_bodies) return std::nullopt;
    return context_.bodies.line(part.start_from_exit.translation, task.start.colour, task.span);
}

/// Whether there is room for another part. If not, composing gives up, or that is an error.
bool LsysComposer::has_room(Span span) {
    const std::size_t count = parts_.size();
    const bool too_large = parts_.bytes() + pool_.bytes() > max_bytes_;
    gave_up_ = count >= stop_from_ || (count >= give_up_from_ && few_serve_twice()) ||
               (too_large && give_up_from_ < SIZE_MAX);
    if (gave_up_) return false;
    const bool hopeless = count >= refuse_from_ && few_serve_twice();
    too_many_parts_ = hopeless || too_large || count + tasks_.size() > max_parts_;
    if (!too_many_parts_) return true;
    context_.diagnostics
        .error(span, fmt::format("the model has more than {} different parts{}",
                                 hopeless    ? refuse_from_
                                 : too_large ? count
                                             : max_parts_,
                                 hopeless    ? ", and hardly any serves twice"
                                 : too_large ? fmt::format(", and they take over {} MiB", max_bytes_ >> 20)
                                             : std::string()))
        .with_hint(rewriter_.explosion_hint());
    return false;
}

/// The frame of a part that begins where the last task is.
PartFrame LsysComposer::frame_of_child(const Placing& placing) const {
    if (!witness_ || sums_) return {};
    const Turtle& turtle = tasks_.back().turtle;
    return tasks_.back().frame.of_child(turtle.start_from_turtle(), placing.scale * turtle.scale());
}

bool LsysComposer::start_task(const Lookup& found, Stage stage, const Unfolded& unfolded) {
    const ModuleId module = found.module;
    const TurtleState& start = found.state;
    const bool repeated = unfolded.stage == stage;
    const unsigned count = repeated ? tasks_.back().repeated + 1 : 0;
    const Span span = unfolded.by->rule->source->span;
    if (count > most_repeated)
        return refuse_endless(rewriter_.grammar(), stage == 0 ? RuleKind::interpret : RuleKind::decompose,
                              rewriter_.modules().symbol(module), span, context_.diagnostics);
    if (!has_room(span)) return false;
    if (sums_) witness_->opens_part();
    const bool interprets = unfolded.kind == RuleKind::interpret;
    const bool as_old = interprets || unfolded.by->rule->keeps;
    tasks_.push_back({.module = module,
                      .stage = stage,
                      .start = start,
                      .rule = unfolded.by->rule,
                      .string = unfolded.by->successor,
                      .string_stage = unfolded.stage,
                      .birth = as_old ? start.birth : birth_at(unfolded.stage),
                      .interprets = interprets,
                      .span = span,
                      .turtle = Turtle(context_, start),
                      .repeated = count,
                      .placing = found.placing,
                      .frame = frame_of_child(found.placing)});
    Task& task = tasks_.back();
    if (unfolded.random) task.turtle.read_variant();
    if (unfolded.aged) task.turtle.read_birth();
    if (unfolded.by->rule->draws == 0) return true;
    const ModuleString* const drawn =
        rewriter_.successor(*unfolded.by, module, unfolded.moment, unfolded.draw);
    if (!drawn) return false;
    task.drawn = *drawn;
    task.string = task.drawn;
    return true;
}

/// Makes the last task a known part. False where a witness ends it.
bool LsysComposer::complete_task() {
    Task task = std::move(tasks_.back());
    tasks_.pop_back();
    TurtlePart part = std::move(task.turtle).finish();
    clean_exit(part);
    if (witness_) {
        Task& parent = tasks_.back();
        rewriter_.work_of_part(new_polygon_work());
        if (sums_) part.sums = witness_->closes_part();
        if (!append(parent, part, task.placing, task.interprets)) return false;
        ++parent.at;
        if (sums_) parts_.add(task.module, task.stage, task.start, std::move(part));
        return true;
    }
    if (task.interprets) part.modules = 1;
    std::optional<Instance> line = line_for(part, task);
    const Mat3 frame = context_.limit ? chord_frame(part.start_from_exit.translation) : Mat3(1.0);
    const std::size_t count = part.instances.size();
    count_work(part);
    part.instances =
        pool_.share(std::move(part.instances), std::move(line), name_of_part(task), task.span, frame);
    if (count > 1 && part.instances.size() == 1)
        origins_.try_emplace(part.instances.front().master, Origin{task.module, task.stage / 2});
    parts_.add(task.module, task.stage, task.start, std::move(part));
    return true;
}

/// The control point that stands for all that differ from it by rounding only.
Vec3 LsysComposer::representative(Vec3 point) {
    const double length = lengths_.representative(glm::length(point));
    return length > 0 ? length * ways_.representative(glm::normalize(point)) : point;
}

/// `snap`: the angle between the directions and those in their place.
TurtleState LsysComposer::state_of(const Turtle& turtle, double& snap) {
    TurtleState state = turtle.state();
    if (turtle.is_scaled() && !sizes_) {
        state.width = sizes_known_.representative(state.width);
        state.control_width = sizes_known_.representative(state.control_width);
    }
    if (context_.skin > 0) state.limb_radius = sizes_known_.representative(state.limb_radius);
    if (context_.varies_step) state.ruler = sizes_known_.representative(state.ruler);
    if (context_.varies_angle) state.angle_factor = sizes_known_.representative(state.angle_factor);
    if (context_.two_headings) state.second = rotations_.representative(state.second);
    if (state.in_cylinder) state.control_point = representative(state.control_point);
    if (state.frame) state.frame = representative(*state.frame, snap);
    if (!uses_directions_) return state;
    const TurtleState exact = state;
    state.tropism = directions_.representative(state.tropism);
    state.vertical = directions_.representative(state.vertical);
    if (snaps_)
        snap = std::max({snap, angle_between(exact.tropism, state.tropism),
                         angle_between(exact.vertical, state.vertical)});
    return state;
}

/// The directions of tropisms are snapped; the rest differs by rounding only.
std::shared_ptr<const TurtleFrame> LsysComposer::representative(const TurtleFrame& exact, double& snap) {
    auto frame = std::make_shared<TurtleFrame>(exact);
    const bool mirrored = glm::determinant(exact.axes) < 0;
    if (mirrored) frame->axes[0] = -frame->axes[0];
    frame->axes = rotations_.representative(frame->axes);
    if (mirrored) frame->axes[0] = -frame->axes[0];
    frame->origin = representative(exact.origin);
    frame->unit = sizes_known_.representative(exact.unit);
    for (Tropism& tropism : frame->tropisms) {
        if (tropism.elasticity == 0) continue;
        const Vec3 direction = tropism.direction;
        tropism.direction = directions_.representative(direction);
        if (snaps_) snap = std::max(snap, angle_between(direction, tropism.direction));
    }
    return frame;
}

/// `A_5` for module A with five steps left.
std::string LsysComposer::name_of_part(const Task& task) const {
    const std::string& symbol = rewriter_.grammar().symbols[rewriter_.modules().symbol(task.module)];
    return fmt::format("{}_{}", object_name(symbol), task.stage / 2);
}

} // namespace graftal
