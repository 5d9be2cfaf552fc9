"""Every tolerance of the project, in one place, with the reason for its size.

Lengths are mm unless the name says otherwise. Relative tolerances multiply the size named beside them.
"""

from __future__ import annotations

#: Two path ends closer than this are the same point: well under the printer's 0.0001 mm output grid.
JOIN_MM = 1e-6

#: Largest difference of an emitted arc's start and end radius: LinuxCNC and Marlin planners accept this.
ARC_RADIUS_MM = 0.002

#: A triangle is degenerate when its height is under this fraction of its longest edge.
DEGENERATE_HEIGHT = 1e-10

#: Overlap of a flat piece is nothing when under this fraction of the piece's area.
OVERLAP_FRACTION = 1e-6

#: A layout whose mean d is larger is refused: lengths are off a thousand times, and written digits no longer tell triangles apart.
WILD_DISTORTION = 1e6

#: Barycentric weights of a point must sum to 1 within this.
WEIGHT_SUM = 1e-6

#: Mould cavity volume must equal area x depth within this fraction.
CAVITY_FRACTION = 0.005

#: Chord tolerance where a preview or a mesh needs a polyline.
PREVIEW_CHORD_MM = 0.02

#: The same where wet ink is kept off wet ink: a hundredth of a bead's width.
INK_CHORD_MM = 0.005

#: A limit that a file sets is the profile's own if it differs by less: both are written with a few digits.
SETTING_FRACTION = 1e-4

#: No single dwell amid the ink is longer than this, s: Ecoflex 00-30 pours for 45 minutes at room temperature by its maker's sheet
#: (longer with a retarder, shorter where it is warm), and a third of that is taken from all that is still to be printed.
WET_DWELL_S = 900.0

#: Least slack of a triangle inequality, as a fraction of the mean edge: needles below it are mollified.
MOLLIFY = 1e-9

#: d of at most this much above 4 is flat: lengths are kept within a twentieth of a percent.
FLAT_EXCESS = 1e-6

#: Newton on d stops when the next step promises less than this fraction of what is left above 4.
NEWTON_DECREASE = 1e-4

#: While seams are searched it need not be driven so far: d is known to 1 % of what is above 4.
SEARCH_DECREASE = 1e-2

#: Added to the Newton system's diagonal, as a fraction of its mean, so that rigid motions are fixed.
NEWTON_RIDGE = 1e-9

#: A start whose smallest singular value is under this fraction of its largest is taken from Tutte instead.
FLAT_START = 1e-3

#: Mould outlines lie on this grid: single precision (an STL file) tells its points apart up to 800 mm.
MOULD_GRID_MM = 1e-4

#: A slit of the outline narrower than this is no wall in any printer; its two sides are joined.
MOULD_SLIT_MM = 0.01

#: The thinnest wall a slicer keeps: one line of the commonest nozzle.
PRINTABLE_WALL_MM = 0.4

#: Step to which a message rounds a pattern's parameter: finer than any printer places a bead.
PARAMETER_STEP_MM = 0.001

#: Parameters may miss a bound by this much: 0.1 + 0.2 is more than 0.3 by rounding, and no printer knows.
PARAMETER_ROUNDING_MM = 1e-9

#: No pattern has a parameter longer than this: no bed is, and a path of millions of turns would take all memory.
LARGEST_PATTERN_MM = 1000.0

#: No bead is narrower: half of what the finest dispensing nozzles lay.
LEAST_BEAD_MM = 0.05

#: An arc whose ends lie closer than this is printed as a line: 100 cells of the 0.0001 mm output grid, below which
#: rounding could turn its end behind its start and so make a full circle of it.
SHORT_ARC_MM = 0.01

#: Rounding places to 0.0001 mm changes the flow along a bead by less than this share where it is longer than 0.2 mm;
#: along a shorter one, or where rounding left out the shape before it, the head is slowed down to keep it. Under the
#: spare of 8e-4 that a check leaves a flow at its limit.
GRID_FLOW_FRACTION = 5e-4

#: Rates of a pump that is a spindle (GRBL's S) are the same where they differ by less than this share: one step of an
#: 8-bit PWM, which is what most boards make of S. The head is slowed down by as much, so the ink per mm is not touched.
SPINDLE_FRACTION = 1 / 255

#: A point this far (barycentric) outside a flat triangle still lies in it: rounding must open no gap between neighbours.
BARYCENTRIC = 1e-9

#: Clearances may fall short by this much before a sensor is refused: rounding, a thousandth of a printer's step.
CLEARANCE_MM = 1e-6

#: Interior edges sharper than this are creases of the object: a contact sensor bent over one would break or read as touched.
CREASE_RAD = 0.5235987755982988  # 30 degrees

#: Creases shorter than this altogether are noise of a scan; the smallest sensor is as wide.
CREASE_LENGTH_MM = 10.0

#: A triangle is a sliver (reported, kept) when its height is under this fraction of its longest edge:
#: its cotangents exceed 1000, where a plain cotangent Laplacian loses three digits.
SLIVER_HEIGHT = 1e-3

#: Holes with more border edges than this are openings of the object (the base of a finger), not damage; --repair keeps them.
REPAIR_HOLE_EDGES = 30

#: Parts smaller than this fraction of the mesh's diagonal are specks of a scan; --repair removes them.
REPAIR_SPECK = 0.02

#: Cells of the raster on which places for sensors are looked for: a piece of 150 x 150 mm gets steps of 0.25 mm.
RASTER_CELLS = 360_000

#: Finest step of that raster; found places are verified exactly, so it decides only how tight a fit is found.
RASTER_STEP_MM = 0.2

#: Boundary edges push a vertex away within this fraction of the median boundary edge, so that flat pieces do not overlap.
APART_REACH = 0.03

#: Weight of that push beside the mean d: only its reach matters, it grows without bound towards contact.
APART_WEIGHT = 1e-5

#: A piece with d above this anywhere is warned of: one direction is off by a factor of nearly three (2.8^2 + 2.8^-2 + 2).
CAUTION_D_MAX = 10.0

#: So is one whose 99 % quantile of d is above this: a hundredth of it is off by 1.4 or more (1.4^2 + 1.4^-2 + 2 = 4.47).
CAUTION_D_P99 = 4.5

#: A sensor with more wrap strain than this anywhere is warned of: its resistance there is off by a fifth.
CAUTION_WRAP_STRAIN = 0.10

#: A sensor is asked for at a point no farther from the surface than this fraction of the object's diagonal: points read off a
#: screen or a drawing miss by less, and those of another scale, unit or origin by far more.
POINT_FRACTION = 0.05

#: A joint lies inside the object, so it may be farther from the surface: by this fraction of the diagonal.
JOINT_FRACTION = 0.5

#: Objects outside this range are mistakes of units: squares and products of their lengths leave the range of numbers.
SMALLEST_OBJECT_MM = 1e-9
LARGEST_OBJECT_MM = 1e9

#: Least cotangent weight of an as-rigid-as-possible step.
RIGID_WEIGHT = 1e-3

#: Prescribed turning angles may miss 2 pi by this much: written with six decimals, they do.
TURNING_SUM_RAD = 1e-5

#: Prescribed boundary edges may come out longer or shorter by this fraction to close the curve: most do by under a hundredth,
#: and where one is off by more the map is no longer what was asked for.
CLOSED_LENGTH = 0.25

#: A triangle of a layout under this fraction of its size has shrunk to nothing: rounding is a hundredth of its sides.
SHRUNK = 1e-14

#: Target shapes are reached when no boundary vertex moves by more than this fraction of the shape's size.
TARGET_MOVE = 1e-10

#: ... and so nearly that no more need be done: a tenth of a micrometre on a hand's width.
TARGET_SETTLED = 1e-6

#: Sliding along a target curve stops when a step lowers the conformal energy by less than this fraction: the map itself is
#: only as near to conformal as the mesh is fine.
CURVE_DECREASE = 1e-3

#: A log scale factor (or a vertex's curvature, rad) under this is rounding: there is nothing left for a cone to take in.
FLAT_SCALE = 1e-9

#: An edge is flipped when its two cotangents sum to less than minus this fraction of their sizes: rounding flips none.
DELAUNAY_COTANGENT = 1e-9

#: Weight (half the cotangents' sum) of an edge that had a negative one but could not be flipped: a third of an equilateral
#: mesh's. From 1e-4 to 0.2 no fewer triangles flip, but the few concerned come out a hundred times less squashed.
LEAST_EDGE_WEIGHT = 0.2

#: A layout carried over from a simplified mesh is kept where the mean d could lose at most this: a twenty-fifth of what
#: separates a perfect piece from the usual bound of 4.05.
SIMPLIFY_EFFECT = 0.002

#: Offsetting, a triangle folds when less than this fraction of its area is left, seen along its old normal: what is nearly
#: gone has no shape to flatten either.
OFFSET_LEAST_AREA = 0.05

#: An offset surface meets itself where it lies nearer to the object than this fraction of the distance: chords of a curve and
#: rounded-off edges take a few per cent, and silicone gives way by as much as the rest.
OFFSET_NEAR = 0.8

#: No vertex moves by more than this many times the offset: a cube's corner needs the root of 3, and a blade's would fly off.
OFFSET_MITRE = 2.0

#: Faces about a vertex count as planes of their own where their normals differ by the second of these (two of them, rad), and as
#: one curved surface below the first: there the sideways part of a least-squares fit is mostly noise of the triangulation.
OFFSET_CREASE_RAD = (0.3490658503988659, 0.5235987755982988)  # 20 and 30 degrees

#: Newton's search for the peak of a tactel array stops at steps below this, tactels: the seed's, 0.04 mm along the finger.
NEWTON_TACTELS = 0.01

#: Three tactels in a row of this share of the highest are a flat top: a small contact's neighbours in the seed's spacing read under
#: a half of it, and in twice its density under 0.85.
PEAK_FLAT = 0.9

#: Another peak of a frame is a contact of its own from this share of the highest on: interpolation's ripples stay under a fifth.
PEAK_OTHER = 1 / 3

#: What the contacts found leave of a frame may be another contact from this share of its highest reading on. With gains that are off by
#: 3 % a finger of a tenth of another's force, 3 tactels off, is found in 102 of 120 frames at 0.05, 92 at 0.07, 56 at 0.1, none at a third.
SEVERAL_OTHER = 0.05

#: A contact of less than this part of the strongest's force is one only so many tactels from any other: what two points leave of a disc
#: of 5 mm or a square of 12 mm has the force of a fifth at most and lies 1.1 to 1.7 tactels from them.
SEVERAL_LIGHT, SEVERAL_TACTELS = 1 / 3, 1.8

#: Points that explain a frame may be a line's where two lie nearer, tactels: those of a rod 12 mm long are up to 1.9 off.
SEVERAL_NEAR = 2.2

#: A fit of forces to a tactel array stops at steps below this: a tenth of what noise of one percent moves them; what is left is its square.
MATCH_MM = 5e-3

#: One force on the array explains a frame that leaves less than this part of the sum of squares: gains that are off by 3 % leave
#: a thousandth, a rod 8 mm long five times as much.
MATCH_UNEXPLAINED = 4e-3

#: Two forces are better than one where they leave less than this part of what the one left.
MATCH_APART = 0.2

#: A contour of deflection keeps its height within this part: a ten thousandth of a tactel where the surface is steep.
CONTOUR_HEIGHT = 1e-6

#: A fit of a line to a tactel array stops where its direction turns by less than this: a fiftieth of a degree.
LINE_STEP_RAD = 3.5e-4

#: A direction whose standard deviation is larger is not sure: two of these are 10 degrees, half of the seed's worst error.
LINE_UNSURE_RAD = 0.08726646259971647  # 5 degrees

#: Another direction explains a frame as well where it leaves less than so many variances of a reading more: a chance of one in seventy.
LINE_RIVAL = 6.0

#: A line is better than a round patch where the patch leaves this part more than it does: with gains that are off by 3 % one disc of 4 mm
#: in thirty gets there, the hardest to tell, and nine rods of ten that lie across the finger between two stripes.
LINE_BETTER = 0.4

#: Where (1 + nu) (1 - 2 nu) is less, the integral of an array's deflections is under a tenth of what it is in a soft foam, and noise.
COMPRESSIBLE = 0.1

#: An angle of force is none where a profile leaves more than this part unexplained: interpolation alone leaves up to a tenth.
SPLIT_UNEXPLAINED = 0.25

#: A bright spot is a pin's tip from and to these parts of the usual spot's area: a tip of six pixels keeps two to eighteen, specks have
#: one, and a fingertip's rim has a hundred times as many.
PIN_AREA = (0.25, 3.0)

#: A pin's tip is looked for within this part of the distance to its nearest neighbour: from a half on it could be the neighbour's.
PIN_REACH = 0.55

#: Rounds in which pins that were not found are looked for beside their neighbours: three find all there are where tips scatter by 0.3 mm;
#: in a frame full of specks each would find a speck or two more, in as many rounds as there are pins.
PIN_ROUNDS = 4

#: So many neighbours say where a pin that is not found has gone: those round it in a hexagonal pattern.
PIN_NEIGHBOURS = 6

#: A spot that this part of the images have is a pin; others are specks and reflections.
PIN_KEPT = 0.9

#: An image at rest is of the camera that was moved where shift and turn leave so much of a pin's pitch, root mean square: at most 0.075 is
#: left where the pins' usual places stand for rest, 0.1 to 0.43 once the camera has moved by half a pitch at the rim.
PIN_SEATED = 0.09

#: Principal components of the pins' places that are kept: with 20 an edge is read a quarter better on real images than with 80, the rest
#: of which are the pixels' noise, and in half the time.
PIN_COMPONENTS = 20

#: An edge is read rightly that is off by no more: a follower that corrects at every step of 1 mm comes back from there, mm and degrees.
EDGE_RIGHT_MM, EDGE_RIGHT_DEG = 1.5, 30.0

#: Images like the one that is read tell by how many of them were read rightly how sure it is: of ten, one that was not is a tenth.
EDGE_SIMILAR = 10

#: How close the learned images lie somewhere is the distance of so many of their nearest: of one alone it would be chance.
EDGE_SPACING = 4

#: Bounds on a piece's mean d by name: the usual one, at which a skin lies as a flat piece does, and two that need less seam
#: (2.23 and 1.87 times the root of the area on average over 13 objects, for 2.72).
BOUNDS = {"standard": 4.05, "short": 4.1, "shortest": 4.2}

#: Root of the area at which seams are looked for: edge collapses (libigl's qslim) add 1e-10 to every quadric, whatever the unit, which
#: at this size gives flat sides sound triangles; at 20 m their triangles were left without area.
SEARCH_SIZE = 0.25

#: Points of that object lie on this grid: a hundred times finer than single precision (an STL file) tells them apart, and far coarser
#: than rounding, so that they are the same grid points in any unit.
SEARCH_GRID = 2.0**-32
