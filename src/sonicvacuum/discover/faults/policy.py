"""Numbers that decide between a slip and an effect, each with its reason."""

import math

# Prior of one kind of slip; an effect of the catalogue has about twice as much, none thirty times. A
# laboratory makes some slip in one record of five or so, and there are a score of kinds.
PRIOR = 0.01
# Δχ² that a slip has to gain over the nominal model before it is weighed: the largest of about fifty
# alternatives (a score of kinds at their places) exceeds it by chance in one null of a thousand.
LEAST_GAIN = 18.0
# The size of one that was put right is another one beside effects where that gains so much, two and a half of
# its errors: it is known to be there.
OTHER_SIZE = 6.0
# A slip is put right before any effect is searched for where it takes away this share of all misfit ...
SHARE = 0.9
# ... and gains so much that no prior matters.
SURE_GAIN = 200.0
# One of a single run, which no effect singles out, is put right before sets of effects are asked for where it
# takes away that share, gains so much, and as much more than any effect alone.
LIKELY_GAIN, AHEAD = 60.0, 30.0
# Two runs are exchanged whatever else acts in them where their speeds differ by so many stated errors, and a
# fit strikes each within this share of the difference (of logarithms) from the speed of the other.
FAR_APART, EXCHANGED = 10.0, 0.25
# One that leaves more than this share of it is held against every effect alone first.
REST = 0.01
# Where the best effect leaves more than so many times the χ² of noise, and no less than `SURE_GAIN`, a slip
# beside which an effect leaves noise alone needs not be held against sets of effects.
GROSS = 1.0
# Where it leaves more than so many times that, exchanges of gauges that explain nothing by themselves are
# asked as well: in a chain that takes most of a pulse the gauge in front reads most, so that gauges which
# stand exchanged may be nearer to the nominal model than in their places.
BURIED = 4.0
# Beside a whole slip that takes away more than this share of the misfit every effect is asked. In made ones
# with one beside an effect of d' 150 or 500 it takes 0.85 and more where effects that lead without it tell
# nothing; in a real record whose misfit no effect explains, 0.03.
MOSTLY = 0.5
# An effect that leaves less than this share of the misfit is there, whatever slip was made beside it.
NEARLY = 0.1
# A slip that leaves more than this share of the misfit, whatever else is added, is no explanation.
LEFT = 0.3
# Slips that are followed to their minimum after a linear look at all of them.
FOLLOWED = 4
# Where slopes know nothing of a slip, a fit may take away much of what its correction leaves at first: all
# but a 180th where two runs had been swapped, a 330th where they had not. One that leaves more than so many
# times the misfit as it is explains nothing, and is not fitted.
REACH = 300.0
# A table of fewer values than this says nothing of a single one.
FEWEST_VALUES = 8
# What is wrong in a table by itself, a value or the stated errors, is put right before any effect is searched
# for where it gains so much (a value six or seven errors off), more than half of all misfit, and more
# than any effect alone.
SURE_VALUES, SHARE_VALUES = 30.0, 0.5
# A value shows by itself that it is wrong where so much χ² of a straight course over the runs goes with it,
# and so many times what is left of all courses beyond noise then: in 200 sound tables, of effects as strong
# as 50 standard errors, it is 5.5 times that at most.
PLAIN_GAIN, PLAIN_RATIO = 100.0, 10.0
# Δχ² that the best of all slips and effects gains by chance in values whose errors are as large as their
# misfit says; what gains more is no such chance, and errors are asked for beside it.
CHANCE = 12.0
# Times of all runs that are off by more than this factor (its logarithm) are no effect's: contacts would have
# to be sixteen times as stiff or as soft. To ask every effect so far from the data takes minutes.
OTHER_CLOCK = math.log(3.0)
# Power of the striker's speed with which values go, at most or about.
SPEED_POWER = 1.5
# The speed of a run that a table asks for is off by no more, in its logarithm.
FARTHEST_SPEED = math.log(4.0)
# Relative error of a speed that is stated as exact, so that slopes tell where its run's values lead it.
OPEN_SPEED = 0.01
# Slips of one kind in a table, values by themselves or exchanges of them, that are looked at: those that gain
# most with the model held.
LOOKED_AT = 12
# No more slips than this are put right in one record: a record with more should be made anew.
MOST = 3
# Probabilities below this are not worth a line.
SHOWN = 0.05
# Probability of what the traces show by themselves, far beyond their noise; never 1.
PLAIN = 0.999
# χ² of the nominal model above its number of data, and of its nuisances above theirs, in standard deviations
# of χ², from which slips are looked for.
SUSPICIOUS = 3.0
# A slip with more of the probability than this is not shared with an effect that is like another: it is told.
LIKELIER = 0.5
# Share of what another slip has to explain that suffices for a run that is far off.
ALONE = 0.4
# A slip with a size that takes away less than this share of a misfit of `SURE_GAIN` or more is not followed
# to its end: less than (1 - LEFT) ALONE of it decides nothing.
PART = 0.25
# Slopes foresee this share of what a small slip gains, or more: of beads a tenth too heavy, which gained 31
# beside strained nuisances, they had foreseen 15.
FORESEEN = 0.5


# χ² per datum that a look at a size far off leaves where the size may be right.
ROUGHLY_THERE = 30.0
# Log prior of one that numbers of the record speak for: a ball's mass and its material contradict each other
# where its mass or its size is wrong, or it is hollow, or of another material.
EXPECTED = math.log(0.25)


def log_prior(alternatives: int) -> float:
    """Log prior of one slip of a kind that has so many alternatives in a record."""
    return math.log(PRIOR / max(1, alternatives))
