// A program on a Cortex-M4 without operating system and C library: the vector table, the start, the
// functions that compilers call, and output and exit through semihosting.
#include <cstddef>
#include <cstdint>

extern "C" {

extern std::uint8_t data_start[], data_end[], data_values[], bss_start[], bss_end[];
using Constructor = void (*)();
extern Constructor first_constructor[], last_constructor[];
int main();

void *memcpy(void *to, const void *from, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    static_cast<std::uint8_t *>(to)[i] = static_cast<const std::uint8_t *>(from)[i];
  }
  return to;
}
void *memmove(void *to, const void *from, std::size_t size) {
  if (to <= from) {
    return memcpy(to, from, size);
  }
  while (size-- > 0) {
    static_cast<std::uint8_t *>(to)[size] = static_cast<const std::uint8_t *>(from)[size];
  }
  return to;
}
void *memset(void *to, int value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    static_cast<std::uint8_t *>(to)[i] = static_cast<std::uint8_t>(value);
  }
  return to;
}
int memcmp(const void *one, const void *other, std::size_t size) {
  const auto *a = static_cast<const std::uint8_t *>(one);
  const auto *b = static_cast<const std::uint8_t *>(other);
  for (std::size_t i = 0; i < size; ++i) {
    if (a[i] != b[i]) {
      return a[i] - b[i];
    }
  }
  return 0;
}
void *memchr(const void *text, int value, std::size_t size) {
  auto *a = static_cast<const std::uint8_t *>(text);
  for (std::size_t i = 0; i < size; ++i) {
    if (a[i] == static_cast<std::uint8_t>(value)) {
      return const_cast<std::uint8_t *>(a + i);
    }
  }
  return nullptr;
}
std::size_t strlen(const char *text) {
  std::size_t size = 0;
  while (text[size] != '\0') {
    ++size;
  }
  return size;
}

static int semihosting(int operation, const void *argument) {
  register int r0 asm("r0") = operation;
  register const void *r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

/// Ends the program with an exit code.
[[noreturn]] void board_exit(int code) {
  const std::uint32_t block[] = {0x20026, static_cast<std::uint32_t>(code)};
  semihosting(0x20, block);
  for (;;) {
  }
}
/// Prints a part of a text.
void board_print(const char *text, std::size_t size) {
  char part[129];
  while (size > 0) {
    const std::size_t count = size < sizeof part - 1 ? size : sizeof part - 1;
    memcpy(part, text, count);
    part[count] = '\0';
    semihosting(0x04, part);
    text += count;
    size -= count;
  }
}

[[noreturn]] void reset() {
  memcpy(data_start, data_values, static_cast<std::size_t>(data_end - data_start));
  memset(bss_start, 0, static_cast<std::size_t>(bss_end - bss_start));
  for (Constructor *each = first_constructor; each != last_constructor; ++each) {
    (*each)();
  }
  board_exit(main());
}
[[noreturn]] void fault() { board_exit(99); }

[[gnu::section(".vectors"), gnu::used]] void (*const vectors[16])() = {
    reinterpret_cast<void (*)()>(0x20100000), reset, fault, fault, fault, fault, fault, fault,
    fault, fault, fault, fault, fault, fault, fault, fault};
}
