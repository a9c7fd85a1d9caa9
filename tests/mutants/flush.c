/* Linked into the programs of the coverage build: a child process that ends by _exit() writes its counters, too. The
 * linker puts __wrap__exit in the place of _exit (option --wrap). */
void __gcov_dump(void);
_Noreturn void __real__exit(int code);
_Noreturn void __wrap__exit(int code);

void __wrap__exit(int code) {
  __gcov_dump();
  __real__exit(code);
}
