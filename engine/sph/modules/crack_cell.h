/* What crack_cell.c declares: the width of the cells, and the stress that opens flaws in them. */

INPUT_REAL(fracture, cell, "m", 0, 0, 1e9, .absent = "0", .when = "target.fracture=auto|on",
           .doc = "Width of the cells that crack as one: their particles share flaws, mean stress and damage. Strength "
                  "then depends on this width and not on the number of particles, where a cell holds several "
                  "particles. 0: each particle cracks by itself, as printed.",
           .source = "our choice; BA95 for 0")

COLUMN(crack_stress[5]) /* Pa, what opens the flaws: means over the cell of the particle */
COLUMN(crack_pressure)  /* Pa, likewise */
