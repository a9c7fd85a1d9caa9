/* Undoes templates_on.h, so that the next precision can be switched on. */
#undef TEMPLATE_DOUBLE
#undef TEMPLATE_FLOAT
#undef REAL
#undef REAL_BYTES
#undef INT
#undef SINGLE
#undef TYPED
#undef MM512
