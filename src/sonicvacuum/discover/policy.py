"""Numbers that decide, each with its reason: where `discover` draws its lines.

Fixed here, on other data than those it is tested on, and nowhere else; what only steers a search (how many
starts, how many steps) stands beside the search.
"""

# Probability that pure noise exceeds the threshold of the largest score of the whole catalogue: one null in a
# hundred, and an effect has to pass other tests besides.
FALSE_ALARM = 0.01
# An effect is ten times likelier than none before it is named: at less, one null in six names a spurious
# component; at this, 1.6 % (the comparison of evidences of Nelson et al., Astron. J. 159, 73, 2020).
LEAST_LOG10_BAYES = 1.0
# p below which the nominal model leaves a sure misfit: with nothing to name, only that is called unknown.
NULL_MISFIT = 1e-3
# p below which shapes outside the catalogue are left beside what is named: `unknown` is then the likelier.
SHAPE_MISFIT = 4e-3
# p below which goodness of fit fails: its tests know no shape, and more is asked of them than of shapes.
MISFIT = 1e-3
# What is named must gain as much as the simplest shape outside the catalogue, within a χ² of noise and the
# share by which linear predictions err.
MARGIN, SHARE = 6.0, 0.05
# A set that leaves nothing is named where it is likelier by more than this (natural log) than the best of it
# with one effect less. Of 419 sets of the study of docs/study.md and the seventh sample of docs/again.md 18
# were likelier by less: two were right, and nine stood for one thing outside the catalogue; of the others 315
# were right, and nine stood for such a thing.
FURTHER = 9.0
# Pairs are asked for although the best single effect leaves nothing, where slopes at the nominal model
# promise a Δχ² of so much more than it gains: in 157 records with one effect they promised 14 more at most.
PROMISED = 20.0
# One run may be predicted worse by this share of what a single effect that leaves nothing gains on all: by
# chance one run of three lost 6.2 of 33 to a gap that is there.
BY_CHANCE = 0.25
# Beside what is left, effects are named where they are so many times likelier than all else together.
CLEAR = 1.0
# Where the best explanation leaves more χ² per datum than this, twice the noise, that no longer counts, ...
GROSS = 4.0
# ... and an effect is named that is so surely part of what explains the data.
STANDS_OUT = 0.95
# Its strength then stands off from zero by more than so many standard errors.
SEEN = 3.0
# Beside one effect, and beside more, it takes away this share of what they leave: in nine records of real
# chains the second effect, on which specimens agree, takes away 27 % and more, a third one, another in each,
# 15 to 45 %.
TAKES_AWAY = (0.25, 0.4)
# Effects that are less surely there are not told of.
TOLD = 0.05
# No more effects than this are named together: a set of more is not looked through in any sense.
MOST_EFFECTS = 6

# Smooth misfit. Correlation times tried, over the pulse's width at half height, the first one first: less
# would be a ripple on the pulse, more a change of its height.
SMOOTH_LENGTHS = (0.5, 0.35, 0.8, 1.2)
# It sets in with the pulse, or ahead of it: when it begins, from the peak, and for how long it rises, in
# widths; both are tried.
SMOOTH_ONSETS = ((-1.5, 1.0), (-1.75, 0.75))
# Shares of its variance tried that are alike in runs of like speeds, and how far apart such speeds lie (in
# their logarithm): a factor of two.
SMOOTH_ALIKE, SMOOTH_SPEEDS = (0.0, 0.9), 0.7
# Around the size found first others are tried as far as this factor; what varies by less than this share of
# the largest variance is left out.
SMOOTH_NEAR, SMOOTH_FAINT = 4.0, 1e-9
# Knots per trace at most; longer traces are given a longer correlation.
SMOOTH_KNOTS = 48
# Memory that all kernels of a record may take.
SMOOTH_BYTES = 400_000_000
# Sizes tried, as shares of the peak: from what the simulation itself errs by to where no model is left.
SMOOTH_LEAST, SMOOTH_MOST, SMOOTH_SIZES = 2e-4, 0.5, 34
# It is at most so many times the root mean square of what a model leaves in a trace: of sixty directions
# nuisances and parameters take up a few.
SMOOTH_TAKEN_UP = 1.5
# What is rougher than its kernel is counted as white: tried are noises so many times, and powers of it, as
# large as they are.
EXCESS_STEP = 1.3
# A systematic error tends to be the same in every run, so that runs do not average it away: where the data
# are not asked, this share of its variance is taken as common.
SMOOTH_SHARED = 0.5
# Beside it the first effect has to gain so many times what else suffices, and a further one so many times: no
# kernel is quite what the discrepancy is. At what else suffices (a Δχ² of some 13) one of 48 empty records
# with 0.3 to 3 % had an effect, of 21.
BESIDE_SMOOTH = (1.75, 3.0)
# Log prior odds of a smooth misfit against none, and its Occam factor: one size, known to a fifth, out of
# three decades.
SMOOTH_LOG_PRIOR = -5.0

# Standard error of the noise's own standard deviation, relative: a quiet stretch of a thousand samples.
SIGMA_REL = 0.02

# Two effects whose changes of all data have this cosine are one explanation with two names ...
ALIAS_COSINE = 0.999
# ... unless the data tell them apart by more than this Δχ².
ALIAS_GAIN = 4.0
# An effect has a size beside something unknown, which counts as noise, from so many of its errors on.
IDLE = 1.0
# χ² of a nominal fit above the number of data, in standard deviations of χ², from which it may have ended in
# one of several minima and starts once more from running integrals; by how much another minimum is lower.
MINIMA, SAME_MINIMUM = 3.0, 0.5
# Where a nominal fit has stopped short of its minimum by more than this share of what the leading effect
# gains, the search begins anew from the minimum; by less, that takes its place.
STOPPED_SHORT = 0.1
# A fit that ends at a bound could fit better: where the named effect or a rival within this Δχ² has, what is
# named is not held surer than that.
RIVAL, AT_BOUND = 9.0, 0.6
# What is named although something else has the larger evidence, which failed a test, is as probable as such
# names came true in the study of docs/study.md: `none` 17 times of 47, `unknown` 31 times of 36; and more so
# than the likeliest of the others. Of sets, with or without something unknown, too few are known: twice as
# probable as all others together.
REFUSED_NONE, REFUSED_UNKNOWN, REFUSED = 0.36, 0.86, 2.0 / 3.0

# Odds of a bead's mass and of a gap beside what nothing of the catalogue explains: of 52 single names beside
# something from outside it alone 34 were one of these two, 18 one of the twenty others (docs/again.md).
NEAREST = 0.05
# p of shapes left beside a smooth misfit below which what is unknown is more than smooth. A smooth error is
# not quite what it is taken for: of 48 such records three left 7e-4 to 4e-3; of 58 with something from
# outside the catalogue 47 left less than 1e-4, three more than 4e-3 (docs/again.md).
SHAPED = 1e-4
# One effect named beside something unknown is at most so probable. Where what is unknown is smooth and leaves
# no shape, 50 of 51 single names were hidden. Where it has shapes 25 of 30 were, of 90 records with an effect
# and something from outside the catalogue, and none of 27 in 272 with that alone; the two are taken as
# equally likely (docs/again.md). Of sets beside what is smooth too few are known: one is only just the
# likeliest.
SMOOTH_BESIDE, ONE_BESIDE, SMOOTH_SET_BESIDE = 0.95, 0.65, 0.51
# All sets beside what has shapes are so probable together: of 64 that were named beside something unknown, a
# few of them beside what is smooth, none was right as a whole. In 18 of 20, of 156 records with an effect and
# something from outside, the effect was among them; with that alone 20 of 272 records had one. Of what sets
# lose so much goes to one of their effects, the rest to none.
SET_BESIDE, ONE_OF_SET = 0.05, 0.6

# A free-form law is kept where it is so much likelier than none, or than names beside something unknown
# (natural log), ...
LAW_LOG_BAYES = 7.0
# ... and closes this share of what was left, as fitted and on runs left out of its fit.
LAW_CLOSES = 0.5
# Its first group of coefficients takes away this share of what is left, or none is tried with it; a further
# one this share of what those before leave.
LAW_FIRST, LAW_FURTHER = 0.1, 0.25

# Standard errors from the middle of a Gaussian to either end of its 90 % interval; one tail holds 5 %.
NINETY = 1.645
