/* What crack_cell.c declares: the width of the cells, and the stress that opens flaws in them. */

MODULE(crack_cell)
MODULE_INPUTS(crack_cell)

#ifdef SPH_MODULE_STRUCTS
struct sph_crack_cell_inputs {
  double width; /* m; 0: off */
};
#endif

COLUMN(crack_stress[5]) /* Pa, what opens the flaws: means over the cell of the particle */
COLUMN(crack_pressure)  /* Pa, likewise */
