/* What artificial_stress.c declares. */

INPUT_REAL(method, artificial_stress, "1", 0, 0, 1,
           .doc = "Monaghan's epsilon against clumping in tension, for bodies that do not crack. 0: it is absent.",
           .source = "Monaghan 2000; Gray, Monaghan & Swift 2001")
