#include "compiler/lsys/derive/deriver.h"

#include <utility>

namespace graftal {

namespace {

/// The random sequence of a step that decomposes; those at the positions of a word choose productions.
constexpr std::uint64_t decomposing = UINT64_MAX;

} // namespace

LsysDeriver::LsysDeriver(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t seed,
                         std::uint64_t max_modules)
    : rewriter_(rewriter), diagnostics_(diagnostics), random_(seed), max_modules_(max_modules),
      decomposer_(rewriter, diagnostics, max_modules), successors_(rewriter, decomposer_, diagnostics),
      matcher_(rewriter.grammar(), rewriter.modules()) {
    const LsysGrammar& grammar = rewriter.grammar();
    is_timed_ = grammar.time(RuleKind::produce) != 0;
    has_cuts_ = has_cuts(grammar);
    if (grammar.in_order) ordered_.emplace(rewriter, matcher_, diagnostics, max_modules);
}

std::optional<ModuleString> LsysDeriver::derive(unsigned steps) {
    const bool derived = derive_to(steps);
    rewriter_.set_birth(ModuleTable::no_birth);
    if (ordered_) ordered_->end();
    if (!derived) return std::nullopt;
    next_ = {};
    return std::exchange(word_, {});
}

bool LsysDeriver::derive_to(unsigned steps) {
    steps_ = steps;
    failed_ = failed_ || !rewriter_.prepare(steps) || !begin();
    changed_ = true;
    while (!failed_ && changed_ && step_ < steps) {
        failed_ = !set_step(step_ + 1) || !step();
        const std::uint64_t distinct = rewriter_.modules().size();
        gave_up_ = !failed_ && distinct >= gives_up_from_ && little_repeats(distinct, word_.size());
        if (gave_up_) return false;
    }
    return !failed_;
}

bool LsysDeriver::set_step(unsigned step) {
    step_ = step;
    rewriter_.set_birth(step);
    decomposer_.set_step(step);
    successors_.begin_step(step);
    return !ordered_ || ordered_->begin_step(step, random_.sequence(step));
}

bool LsysDeriver::begin() {
    if (!set_step(0)) return false;
    auto axiom = rewriter_.axiom();
    if (!axiom) return false;
    word_ = std::move(*axiom);
    if (decomposer_.has_rules() && !decompose()) return false;
    return finish_step() && is_short_enough(word_.size());
}

bool LsysDeriver::step() {
    if (successors_.sees_word()) matcher_.look_at(word_);
    if (!(ordered_ ? rewrite_in_order() : rewrite()) || !finish_step()) return false;
    // Without chance, a word that a step leaves as it was stays so for ever; next_ is the word before.
    changed_ = ordered_ || stage_ || successors_.is_stochastic() || decomposer_.varies() || is_timed_ ||
               word_ != next_;
    return true;
}

bool LsysDeriver::rewrite() {
    const std::optional<std::uint64_t> length = successors_.is_plain() ? count() : choose_runs();
    if (!length || !is_short_enough(*length)) return false;
    gather(*length);
    return !decomposer_.varies() || decompose();
}

bool LsysDeriver::rewrite_in_order() {
    next_.clear();
    const bool rewritten = ordered_->rewrite(word_, next_);
    word_.swap(next_);
    return rewritten;
}

bool LsysDeriver::finish_step() {
    if (has_cuts_) cut_branches(rewriter_.grammar(), rewriter_.modules(), word_);
    if (ordered_ && !ordered_->end_step(step_ == steps_)) return false;
    return !stage_ || stage_(step_, word_);
}

/// The length of the next word, of a grammar without chance and contexts.
std::optional<std::uint64_t> LsysDeriver::count() {
    std::uint64_t length = 0;
    rewriter_.work(word_.size());
    for (const ModuleId module : word_) {
        const LsysSuccessors::Entry run = successors_.entry(module);
        if (run == LsysSuccessors::unknown) return std::nullopt;
        length += successors_.runs().length(run);
    }
    return length;
}

/// The length of the next word, of a grammar with chance or contexts; leaves the runs in chosen_.
std::optional<std::uint64_t> LsysDeriver::choose_runs() {
    const CounterRandom random = random_.sequence(step_);
    chosen_.clear();
    chosen_.reserve(word_.size());
    std::uint64_t length = 0;
    for (std::uint32_t i = 0; i < word_.size();) {
        rewriter_.work();
        const LsysSuccessors::Entry entry = successors_.entry(word_[i]);
        if (entry == LsysSuccessors::unknown) return std::nullopt;
        std::optional<LsysSuccessors::Replacement> by = LsysSuccessors::Replacement{entry};
        if (!LsysSuccessors::is_run(entry)) by = successors_.choose(word_[i], entry, random(i), matcher_, i);
        if (!by) return std::nullopt;
        chosen_.push_back(by->run);
        length += successors_.runs().length(by->run);
        i += by->modules;
    }
    return length;
}

void LsysDeriver::gather(std::uint64_t length) {
    rewriter_.work(length);
    next_.clear();
    next_.reserve(length);
    if (successors_.is_plain())
        successors_.runs().append(
            word_.size(), [&](std::size_t i) { return successors_.run(word_[i]); }, next_);
    else
        successors_.runs().append(
            chosen_.size(), [&](std::size_t i) { return chosen_[i]; }, next_);
    word_.swap(next_);
}

bool LsysDeriver::decompose() {
    ModuleString decomposed;
    if (ordered_ ? !ordered_->decompose(word_, decomposed)
                 : !decomposer_.run(word_, random_.sequence(step_).sequence(decomposing), decomposed))
        return false;
    word_ = std::move(decomposed);
    return is_short_enough(word_.size());
}

bool LsysDeriver::is_short_enough(std::uint64_t length) {
    return graftal::is_short_enough(rewriter_.grammar(), length, max_modules_, step_, diagnostics_);
}

} // namespace graftal
