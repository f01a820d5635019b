// Makes instances of the groups of one object: copies of repeats, choices of chance, places of scatters.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/inst/lower_scatter.h"
#include "compiler/inst/lowerer.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/lower/permutation.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"
#include "compiler/support/stage_price.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

constexpr std::uint32_t variant_mask = inst_variants - 1;

bool same_parameters(const InstDefinition& a, const InstDefinition& b) {
    return std::ranges::equal(a.parameters, b.parameters, {}, &InstParameter::name, &InstParameter::name);
}

} // namespace

void InstLowerer::Lowered::add(Instance instance, const Placement& placement) {
    object.instances.push_back(std::move(instance));
    hues.instances.push_back(placement.hue);
    inks.instances.push_back(placement.ink);
}

bool InstLowerer::holds(const InstGroup& group) {
    return std::ranges::all_of(group.conditions, [&](const InstCondition& condition) {
        const auto [known, fresh] = tests_.try_emplace(condition.test.get(), false);
        if (fresh) {
            const std::optional<double> value = evaluate(condition.test->test, environment_, scratch_);
            if (!value) return false;
            known->second = *value != 0;
        }
        return known->second == condition.wanted;
    });
}

void InstLowerer::lower_group(const InstGroup& group, Lowered& object) {
    if (!holds(group)) return;
    if (group.scatter) return lower_scattered(group, object);
    lower_copies(group, 0, Placement(), object);
}

// Repeats

void InstLowerer::lower_copies(const InstGroup& group, std::size_t depth, const Placement& around,
                               Lowered& object) {
    if (depth == 0 || is_random(group)) draw(group);
    if (depth == group.repeats.size()) return lower_instances(group, around, object);
    const InstRepeat& repeat = *group.repeats[depth];
    const std::optional<std::size_t> count = repeat_count(repeat);
    if (!count) return;
    std::optional<ObjectId> shared;
    if (depth + 1 < group.repeats.size() && shares_copies(group)) {
        Lowered part;
        lower_copies(group, depth + 1, Placement(), part);
        if (stopped_ || part.object.instances.empty()) return;
        const std::string name = free_repeat_name();
        part.object.name = name;
        part.object.span = repeat.span;
        shared = by_name_[name] = graph_.add(std::move(part.object));
        keep_colours(*shared, std::move(part));
    }
    Placement copy = around;
    std::optional<Placement> step;
    for (std::size_t i = 0; i < *count && !stopped_; ++i) {
        if (i > 0) {
            if (is_random(group)) draw(group);
            if (!step || is_random(group)) step = lower_step(repeat);
            const std::optional<Placement> next = step ? composed(copy, *step, repeat.span) : std::nullopt;
            if (!next) return;
            copy = *next;
        }
        if (!shared) {
            lower_copies(group, depth + 1, copy, object);
        } else {
            if (!within_limits(graph_.objects.size(), ++instance_count_, repeat.span, lowering_))
                stopped_ = true;
            lowering_.meter.add(1, StagePrice::copied_instance);
            object.add({*shared, copy.parent_from_child, copy.tint, {}, repeat.span}, copy);
        }
        if (scratch_.has_errors()) return; // the other copies have them too
    }
}

std::optional<std::size_t> InstLowerer::repeat_count(const InstRepeat& repeat) {
    const std::optional<double> count = evaluate(repeat.count, environment_, scratch_, draws_);
    if (!count) return std::nullopt;
    const std::size_t most = lowering_.options.max_objects * max_instances_per_object;
    const double whole = std::floor(*count);
    if (whole >= 1 && whole <= static_cast<double>(most) && (whole == *count || calls_chance(repeat.count)))
        return static_cast<std::size_t>(whole);
    scratch_
        .error(repeat.count.span, fmt::format("a repeat makes a whole number of copies, from 1 to {}, not {}",
                                              most, shortest(*count)))
        .with_hint(whole >= 1 && whole <= static_cast<double>(most) ? "round the count, as in 'floor(n)'"
                                                                    : "write a count in this range");
    return std::nullopt;
}

std::optional<InstLowerer::Placement> InstLowerer::lower_step(const InstRepeat& repeat) {
    const std::optional<Affine> map = lower_transforms(repeat.transforms, environment_, scratch_, draws_);
    const std::optional<Tint> tint = lower_tints(repeat.tints);
    std::optional<InkChange> ink = lower_ink(repeat.ink, environment_, scratch_, draws_);
    if (!map || !tint || !ink) return std::nullopt;
    return Placement{*map, *tint, {}, repeat.hue ? lower_hue(*repeat.hue) : HueTurn(), std::move(*ink)};
}

std::optional<InstLowerer::Placement> InstLowerer::composed(const Placement& parent, const Placement& child,
                                                            Span span) {
    const Affine map = parent.parent_from_child * child.parent_from_child;
    const std::string fault = range_fault(map);
    const bool flattened = is_singular(map) && !is_singular(child.parent_from_child);
    const std::optional<HueTurn> hue = sum(child.hue, parent.hue);
    InkChange ink = parent.ink;
    ink.add(child.ink);
    if (fault.empty() && !flattened && hue && ink.size() <= InkChange::most_steps)
        return Placement{map, graftal::composed({child.tint, parent.tint}), child.material, *hue,
                         std::move(ink)};
    if (ink.size() > InkChange::most_steps)
        scratch_
            .error(span, fmt::format("the copies of this repeat change the ink in more than {} ways",
                                     InkChange::most_steps))
            .with_hint("repeat fewer times, or change the ink of the repeated objects");
    else if (!hue)
        scratch_.error(span, "the turns of these hues have no small common denominator")
            .with_hint("use fractions of a circle, such as 30 or 360/7 degrees");
    else
        scratch_
            .error(span, fmt::format("a copy of this repeat {}",
                                     fault.empty() ? "is singular: it flattens the objects" : fault))
            .with_hint(fault.empty() ? "repeat fewer times, or scale all directions alike" : range_hint);
    return std::nullopt;
}

bool InstLowerer::shares_copies(const InstGroup& group) const {
    const Combination combination = reached_[current_].definition->combination.value_or(Combination::unite);
    if (is_random(group) || group.chance || combination != Combination::unite) return false;
    return std::ranges::none_of(group.masters, [&](const InstReference& master) {
        return chance_.may_recur(master.name) || uses_.contains(master.name);
    });
}

std::string InstLowerer::free_repeat_name() {
    const std::string& owner = reached_[current_].definition->name;
    unsigned& number = repeat_numbers_[owner];
    std::string name;
    do {
        ++number;
        name = number == 1 ? fmt::format("{}.repeat", owner) : fmt::format("{}.repeat{}", owner, number);
    } while (by_name_.contains(name) || index_.any(name));
    return name;
}

bool InstLowerer::copy_work(const InstGroup& group) {
    std::size_t words = group.size;
    for (const auto& repeat : group.repeats)
        words += repeat->size;
    if (count_work(words)) return true;
    if (!stopped_)
        diagnostics_.error(group.repeats.front()->span, "the repeats of the model make too many copies")
            .with_hint("use smaller counts, or repeat an object that contains some of the copies");
    stopped_ = true;
    return false;
}

// Instances

void InstLowerer::lower_instances(const InstGroup& group, const Placement& around, Lowered& object) {
    if (!group.repeats.empty() && !copy_work(group)) return;
    const std::optional<Placement> own = lower_placement(group);
    const std::optional<Placement> placement =
        own && !group.repeats.empty() ? composed(around, *own, group.span) : own;
    instance_count_ += group.masters.size();
    if (!stopped_ && !within_limits(graph_.objects.size(), instance_count_, group.span, lowering_))
        stopped_ = true;
    const double chance = lower_chance(group);
    if (group.below)
        object.object.terminal_px = lower_size_px(*group.below, environment_, scratch_, draws_).value_or(0);
    for (const InstReference& reference : group.masters) {
        const std::optional<ObjectId> master = resolve(reference);
        if (stopped_) return;
        if (!master || !placement) continue;
        Instance instance{*master, placement->parent_from_child, placement->tint, placement->material,
                          reference.span};
        instance.chance = chance;
        if (group.terminal) {
            object.object.terminal = instance;
            object.hues.terminal = placement->hue;
            object.inks.terminal = placement->ink;
        } else {
            object.add(instance, *placement);
        }
    }
}

void InstLowerer::lower_scattered(const InstGroup& group, Lowered& object) {
    lowering_.notes.asks_chance = true;
    draw(group);
    const bool random = std::ranges::any_of(
        group.masters, [&](const InstReference& master) { return chance_.is_random(master.name); });
    std::vector<std::optional<ObjectId>> masters;
    for (const InstReference& reference : group.masters) {
        masters.push_back(resolve(reference));
        if (stopped_) return;
    }
    const std::optional<Placement> placement = lower_placement(group);
    const std::size_t most = lowering_.options.max_objects * max_instances_per_object;
    const ScatterContext context{environment_, graph_.settings, lowering_.options.seed,
                                 most - std::min(most, instance_count_), &lowering_.meter};
    const double chance = lower_chance(group);
    const bool good = placement && std::ranges::count(masters, std::optional<ObjectId>()) == 0;
    bool lost = false;
    std::vector<Instance>& instances = object.object.instances;
    const auto begin = [&](std::size_t count) {
        if (!good) return;
        instance_count_ += count;
        instances.reserve(instances.size() + count);
    };
    const auto take = [&](const ScatteredPlace& place) {
        if (!good || stopped_) return;
        const Affine map = placement->parent_from_child * place.parent_from_child;
        lost = lost || !range_fault(map).empty();
        const InstReference& reference = group.masters[place.master];
        const std::optional<ObjectId> master = random ? resolve(reference) : masters[place.master];
        if (!master) return;
        Instance instance{*master, map, place.tint, placement->material, reference.span};
        instance.chance = chance;
        object.add(std::move(instance), *placement);
    };
    lower_scatter(group, context, {begin, take}, scratch_);
    if (lost)
        scratch_.error(group.span, "the sizes or places of these instances leave the range of numbers")
            .with_hint(range_hint);
}

double InstLowerer::lower_chance(const InstGroup& group) {
    if (!group.chance) return 0;
    const std::optional<double> chance = evaluate(*group.chance, environment_, scratch_, draws_);
    if (!chance || *chance == 0 || (*chance > 0 && is_size(*chance))) return chance.value_or(0);
    const char* const rule =
        *chance < 0 ? "not be negative, but is" : "be 0 or lie between 1e-100 and 1e+100, not";
    scratch_.error(group.chance->span, fmt::format("a chance must {} {}", rule, shortest(*chance)))
        .with_hint("chances are relative to those of the other instances");
    return 0;
}

HueTurn InstLowerer::lower_hue(const Expression& hue) {
    const std::optional<double> degrees = evaluate(hue, environment_, scratch_, draws_);
    if (!degrees) return {};
    if (!(std::abs(*degrees) <= 1e6)) {
        scratch_
            .error(hue.span,
                   fmt::format("a hue turns by at most 1e+06 degrees, not by {}", shortest(*degrees)))
            .with_hint("360 degrees are one whole turn");
        return {};
    }
    const bool random = calls_chance(hue);
    if (!random)
        if (const std::optional<HueTurn> turn = exact_turn(*degrees)) return *turn;
    const HueTurn rounded = whole_degrees(*degrees);
    if (!random && rounded_.insert(&hue).second)
        diagnostics_
            .note(hue.span, fmt::format("the hue turns by {} degrees, not by {}",
                                        shortest(360 * rounded.turns()), shortest(*degrees)))
            .with_hint("tenths of a degree, and 360/n for whole n up to 3600, are exact");
    return rounded;
}

std::optional<InstLowerer::Placement> InstLowerer::lower_placement(const InstGroup& group) {
    Placement placement;
    const std::optional<Affine> map = lower_transforms(group.transforms, environment_, scratch_, draws_);
    const std::optional<Tint> tint =
        group.scatter ? Tint() : lower_tints(group.tints); // tints of a scatter vary
    if (group.material && materials_.contains(*group.material))
        placement.material = materials_.at(*group.material);
    if (group.hue) placement.hue = lower_hue(*group.hue);
    std::optional<InkChange> ink = lower_ink(group.ink, environment_, scratch_, draws_);
    if (!map || !tint || !ink) return std::nullopt;
    placement.ink = std::move(*ink);
    placement.parent_from_child = *map;
    placement.tint = *tint;
    return placement;
}

std::optional<Tint> InstLowerer::lower_tints(const std::vector<InstTint>& tints) {
    std::vector<Tint> lowered;
    for (const InstTint& tint : tints)
        if (const auto value = lower_tint(tint.values, environment_, scratch_, draws_))
            lowered.push_back(*value);
    if (lowered.size() < tints.size()) return std::nullopt;
    return graftal::composed(lowered);
}

std::optional<ObjectId> InstLowerer::resolve(const InstReference& reference) {
    if (unknown_.contains(&reference)) return std::nullopt;
    if (const auto mesh = meshes_.find(&reference); mesh != meshes_.end())
        return primitives_.of(mesh->second);
    std::vector<double> arguments;
    for (const Expression& expression : reference.arguments)
        if (const std::optional<double> value = evaluate(expression, environment_, scratch_, draws_))
            arguments.push_back(*value == 0 ? 0 : *value); // -0 and 0 are one argument
    if (arguments.size() < reference.arguments.size()) return std::nullopt;
    const std::string name = inst_object_name(reference.name, arguments);
    const bool random = chance_.is_random(reference.name);
    // Known objects first: a name may have thousands of patterns.
    if (const auto found = by_name_.find(name); !random && found != by_name_.end()) return found->second;
    const InstDefinition* const definition = index_.match(reference.name, arguments, name);
    if (definition && random) return variant_of(*definition, std::move(arguments), name, reference.span);
    if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
    if (const std::optional<Primitive> plain = primitive_named(name))
        return by_name_[name] = primitives_.of(*plain);
    if (const std::optional<PrimitiveKind> kind = kind_of(reference)) {
        if (const auto known = shapes_.find(name); known != shapes_.end()) return known->second;
        const std::optional<Primitive> made = lower_primitive(*kind, arguments, reference.span, scratch_);
        if (!made) return std::nullopt;
        return shapes_[name] = primitives_.of(*made);
    }
    if (const auto family = families_.find(reference.name); family != families_.end())
        return family->second.exact(arguments, reference.span, scratch_);
    if (definition) return add_object({0, definition, std::move(arguments), reference.span, current_}, name);
    if (const InstDefinition* const other = index_.any(reference.name))
        scratch_
            .error(reference.span, fmt::format("no definition of '{}' matches '{}'", reference.name, name))
            .with_note(other->span, "defined here");
    else if (by_name_.contains(use_of(reference.name)->first))
        return part_of_used(reference.name, arguments, reference.span);
    return std::nullopt;
}

// Chance

bool InstLowerer::is_random(const InstGroup& group) const {
    return !chance_.calls(group).empty() ||
           std::ranges::any_of(group.masters,
                               [&](const InstReference& master) { return chance_.is_random(master.name); });
}

/// FNV-1a. Names choose random numbers; addresses and the order of the text do not.
std::uint64_t InstLowerer::key_of(std::string_view name) const {
    std::uint64_t hash = 0xCBF29CE484222325;
    for (const char c : name)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    return CounterRandom::scrambled(CounterRandom::scrambled(seed_) ^ hash);
}

void InstLowerer::draw(const InstGroup& group) {
    draws_.clear();
    for (const Expression* const call : chance_.calls(group))
        draws_[call] = stratified(reached_[current_].variant, variant_mask, next_place());
}

std::optional<ObjectId> InstLowerer::variant_of(const InstDefinition& definition,
                                                std::vector<double> arguments, const std::string& name,
                                                Span use) {
    const std::uint32_t variant = permuted(reached_[current_].variant, variant_mask, next_place());
    const auto [known, fresh] = variants_.try_emplace(fmt::format("{}/{}", name, variant), 0);
    if (!fresh) return known->second;
    const std::uint64_t key = key_of(name);
    const InstDefinition* const chosen = choose(definition, arguments, key, variant);
    std::string stem = fmt::format("{}.v{}", definition.name, variant + 1);
    while (index_.any(stem) || by_name_.contains(inst_object_name(stem, arguments)))
        stem += '_';
    const std::string own = inst_object_name(stem, arguments);
    std::optional<ObjectId> id;
    if (chosen) id = add_object({0, chosen, std::move(arguments), use, current_, variant, key}, own);
    if (!id) {
        variants_.erase(fmt::format("{}/{}", name, variant));
        return std::nullopt;
    }
    return variants_.at(fmt::format("{}/{}", name, variant)) = *id;
}

const InstDefinition* InstLowerer::choose(const InstDefinition& definition,
                                          const std::vector<double>& arguments, std::uint64_t key,
                                          std::uint32_t variant) {
    if (!definition.weight) return &definition;
    const std::vector<const InstDefinition*> all = index_.alternatives(definition);
    std::vector<double> sums;
    double sum = 0;
    const InstDefinition* names = nullptr; // whose parameters choice_ has
    for (const InstDefinition* const one : all) {
        std::size_t words = 1 + one->weight->span.end - one->weight->span.begin;
        if (!names || !same_parameters(*names, *one)) {
            words += one->parameters.size();
            set_parameters(*one, arguments, choice_);
            names = one;
        }
        if (!reached_.empty() && !work(words)) return nullptr;
        const std::optional<double> weight = evaluate(*one->weight, choice_.values, scratch_);
        if (!weight) return nullptr;
        if (*weight < 0 || *weight > largest_size) {
            scratch_
                .error(one->weight->span,
                       fmt::format("a weight lies between 0 and 1e+100, not at {}", shortest(*weight)))
                .with_hint("weights are relative to those of the other definitions");
            return nullptr;
        }
        sums.push_back(sum += *weight);
    }
    if (sum <= 0) {
        scratch_.error(definition.weight->span, fmt::format("the weights of '{}' are all 0", definition.name))
            .with_hint("give at least one of its definitions a weight above 0");
        return nullptr;
    }
    const double share = sum * stratified(variant, variant_mask, CounterRandom::scrambled(key ^ UINT64_MAX));
    const auto chosen = std::ranges::upper_bound(sums, share);
    return all[chosen == sums.end() ? all.size() - 1 : static_cast<std::size_t>(chosen - sums.begin())];
}

} // namespace graftal
