/* Switches the kernels to one precision, as GSL's templates_on.h does. A kernel's source is included once per
 * precision, between this header and templates_off.h:
 *
 *   #define WIDTH 32                 bytes of a vector register; set once per CPU class
 *   #define TEMPLATE_FLOAT           or TEMPLATE_DOUBLE
 *   #include "engine/sph/pairs/templates_on.h"
 *   #include "engine/sph/pairs/vector.h"
 *   #include "the kernel's source"
 *   #include "engine/sph/pairs/templates_off.h"
 *
 * REAL         the number's type; REAL_BYTES its size; INT the signed integer of that size
 * SINGLE       1 in single precision, else 0
 * TYPED(name)  the name of a type or function in this precision. A source maps each of its names once, for example
 *              `#define vec_less TYPED(vec_less)`, and uses the plain name from there on. Code that needs one
 *              precision in all templates writes vec_less_double.
 * MM512(before, after)  the AVX-512 intrinsic of this precision, where there is AVX-512 */
#if defined(TEMPLATE_DOUBLE)
#define REAL                 double
#define REAL_BYTES           8
#define INT                  int64_t
#define SINGLE               0
#define TYPED(name)          name##_double
#define MM512(before, after) _mm512_##before##pd##after
#elif defined(TEMPLATE_FLOAT)
#define REAL                 float
#define REAL_BYTES           4
#define INT                  int32_t
#define SINGLE               1
#define TYPED(name)          name##_float
#define MM512(before, after) _mm512_##before##ps##after
#else
#error "define TEMPLATE_DOUBLE or TEMPLATE_FLOAT"
#endif
