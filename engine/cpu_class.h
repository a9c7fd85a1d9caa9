/* The x86-64 microarchitecture level of the hot loops. They are compiled for each level; the level is chosen at run
 * time.
 *
 * Results are bit-identical only within one class, because contraction to FMA differs. So a run records its class. The
 * environment variable CLAST_CPU=baseline|v3|v4 limits the class. A class that the machine lacks is replaced by the
 * best one below it. */
#pragma once

#include <stdbool.h>

enum cpu_class { CPU_BASELINE = 1, CPU_V3 = 3 /* AVX2, FMA */, CPU_V4 = 4 /* AVX-512 */ };

enum cpu_class cpu_class_choose(void);
bool cpu_class_known(const char *name);           /* whether `name` is a value of CLAST_CPU */
const char *cpu_class_name(enum cpu_class class); /* "baseline", "v3", "v4" */

/* Address of the variable of this run's class, of those that `stem` names: stem_baseline, stem_v3 and stem_v4. */
#ifdef __x86_64__
#define CPU_CLASS_OF(stem)                                                                                             \
  (cpu_class_choose() == CPU_V4 ? &stem##_v4 : cpu_class_choose() == CPU_V3 ? &stem##_v3 : &stem##_baseline)
#else
#define CPU_CLASS_OF(stem) (&stem##_baseline)
#endif
