/* What viscosity.c declares. */

INPUT_REAL(viscosity, alpha, "1", 1.5, 0, 100, .doc = "Monaghan's linear artificial viscosity.",
           .source = "Monaghan 1992")
INPUT_REAL(viscosity, beta, "1", 3, 0, 100, .doc = "Monaghan's quadratic artificial viscosity.",
           .source = "Monaghan 1992")
