// Made by smachac, as it is for every machine: do not edit.
//
// What blocking and stepped machines share: geometry, and the operations of Python on numbers,
// optional values and sequences. C++17; no allocation, no exception.
//
// Where Python raises an exception, an operation calls `fault.fail(reason)`. In a blocking machine
// this throws. In a stepped machine it keeps the reason, and the operation returns some value of
// its type, which is not used.
#ifndef SMACHAC_OPERATIONS_HPP
#define SMACHAC_OPERATIONS_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace smachac {
inline namespace v0_1_0 {

/// For the class of a record of a script: `names` are its fields, sorted, and `members(value)` is
/// the std::tuple of references to them.
template <class T> struct Fields : std::false_type {};

/// Whether a type is a class of the user whose members smachac does not know.
template <class T> struct Opaque : std::false_type {};

namespace detail {

/// Calls `function(name, member)` for each field of a record.
template <class T, class F, std::size_t... At>
void each_field(T &value, F &&function, std::index_sequence<At...>) {
  auto members = Fields<std::remove_const_t<T>>::members(value);
  (function(Fields<std::remove_const_t<T>>::names[At], std::get<At>(members)), ...);
}
template <class T> constexpr std::size_t count_fields() {
  return std::tuple_size_v<decltype(Fields<T>::members(std::declval<T &>()))>;
}
template <class T, class F> void each_field(T &value, F &&function) {
  constexpr std::size_t count = count_fields<std::remove_const_t<T>>();
  each_field(value, function, std::make_index_sequence<count>());
}
/// Calls `function(member, other)` for the members of a record and as many other values.
template <class A, class B, class F, std::size_t... At>
void each_pair(A &&members, B &&others, F &&function, std::index_sequence<At...>) {
  (function(std::get<At>(members), std::get<At>(others)), ...);
}

} // namespace detail

/// A record with these values of its fields, in the order of `Fields<T>::names`.
template <class T, class... Values> T constant(const Values &...values) {
  T found{};
  detail::each_pair(
      Fields<T>::members(found), std::tie(values...),
      [](auto &member, const auto &value) { member = value; },
      std::make_index_sequence<sizeof...(Values)>());
  return found;
}

/// The type of None.
struct None {
  friend bool operator==(None, None) { return true; }
  friend bool operator!=(None, None) { return false; }
};

/// A point; coordinates in metres.
struct Point {
  double x = 0.0, y = 0.0, z = 0.0;
  friend bool operator==(const Point &a, const Point &b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
  friend bool operator!=(const Point &a, const Point &b) { return !(a == b); }
};

/// A rotation as a unit quaternion.
struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
  friend bool operator==(const Quaternion &a, const Quaternion &b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
  }
  friend bool operator!=(const Quaternion &a, const Quaternion &b) { return !(a == b); }
};

/// A pose: position and orientation.
struct Pose {
  Point position{};
  Quaternion orientation{};
  friend bool operator==(const Pose &a, const Pose &b) {
    return a.position == b.position && a.orientation == b.orientation;
  }
  friend bool operator!=(const Pose &a, const Pose &b) { return !(a == b); }
};

/// The transform between two frames.
struct Transform {
  Point translation{};
  Quaternion rotation{};
  friend bool operator==(const Transform &a, const Transform &b) {
    return a.translation == b.translation && a.rotation == b.rotation;
  }
  friend bool operator!=(const Transform &a, const Transform &b) { return !(a == b); }
};

namespace detail {

template <class T> struct is_list : std::false_type {};
template <class T, std::size_t N> struct is_list<std::array<T, N>> : std::true_type {};
template <class T> struct is_array : std::false_type {};
template <class T, std::size_t N> struct is_array<std::array<T, N>> : std::true_type {};
template <class T> struct is_dict : std::false_type {};
template <class T> struct is_text : std::false_type {};
template <class T> struct is_optional : std::false_type {};
template <class T> struct is_optional<std::optional<T>> : std::true_type {};

/// 2**63 as a float: the least positive whole number that does not fit in 64 bits.
constexpr double beyond_whole = 9223372036854775808.0;

/// Whether a byte is the first byte of a UTF-8 code point.
inline bool is_start(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

/// The code point at the byte offset `place` of a text. The call moves `place` behind it. Bytes
/// that are not UTF-8 give U+FFFD.
inline std::uint32_t code_point(std::string_view text, std::size_t &place) {
  const auto first = static_cast<unsigned char>(text[place++]);
  if (first < 0x80U) {
    return first;
  }
  const int more = first >= 0xF0U ? 3 : first >= 0xE0U ? 2 : first >= 0xC0U ? 1 : 0;
  std::uint32_t point = first & (0x3FU >> more);
  int found = 0;
  for (; found < more && place < text.size() && !is_start(text[place]); ++found) {
    point = (point << 6U) | (static_cast<unsigned char>(text[place++]) & 0x3FU);
  }
  return more == 0 || found < more ? 0xFFFDU : point;
}

} // namespace detail

namespace checked {

/// The result of `function(value)`: computes `value` once where an expression uses it several
/// times.
template <class T, class F> auto with(const T &value, F function) { return function(value); }

template <class Fault, class T> T present(Fault &fault, const std::optional<T> &value) {
  if (!value.has_value()) {
    fault.fail("None where a value is needed");
    return T{};
  }
  return *value;
}

// Arithmetic

/// A whole number as a float, rounded to the nearest one: the operand of float arithmetic.
inline double real(std::int64_t value) { return static_cast<double>(value); }

/// A whole number as a float without rounding. A fault if no float is equal to it.
template <class Fault> double widen(Fault &fault, std::int64_t value) {
  const double result = real(value);
  if (result >= detail::beyond_whole || static_cast<std::int64_t>(result) != value) {
    fault.fail("a whole number that no float holds");
  }
  return result;
}

template <class Fault> std::int64_t add(Fault &fault, std::int64_t a, std::int64_t b) {
  std::int64_t result = 0;
  if (__builtin_add_overflow(a, b, &result)) {
    fault.fail("a whole number too large for 64 bits");
  }
  return result;
}

template <class Fault> std::int64_t subtract(Fault &fault, std::int64_t a, std::int64_t b) {
  std::int64_t result = 0;
  if (__builtin_sub_overflow(a, b, &result)) {
    fault.fail("a whole number too large for 64 bits");
  }
  return result;
}

template <class Fault> std::int64_t multiply(Fault &fault, std::int64_t a, std::int64_t b) {
  std::int64_t result = 0;
  if (__builtin_mul_overflow(a, b, &result)) {
    fault.fail("a whole number too large for 64 bits");
  }
  return result;
}

template <class Fault> std::int64_t negate(Fault &fault, std::int64_t a) {
  return subtract(fault, 0, a);
}
template <class Fault> std::int64_t absolute(Fault &fault, std::int64_t a) {
  return a < 0 ? negate(fault, a) : a;
}
template <class Fault> double absolute(Fault &, double a) { return std::fabs(a); }

template <class Fault> std::int64_t floor_divide(Fault &fault, std::int64_t a, std::int64_t b) {
  if (b == 0) {
    fault.fail("division by zero");
    return 0;
  }
  if (b == -1) {
    return negate(fault, a);
  }
  return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

template <class Fault> std::int64_t modulo(Fault &fault, std::int64_t a, std::int64_t b) {
  if (b == 0) {
    fault.fail("division by zero");
    return 0;
  }
  if (b == -1) {
    return 0;
  }
  const std::int64_t rest = a % b;
  return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

template <class Fault> double divide(Fault &fault, double a, double b) {
  if (b == 0.0) {
    fault.fail("division by zero");
    return 0.0;
  }
  return a / b;
}

/// The quotient of two whole numbers as the nearest float, rounded once.
template <class Fault> double divide(Fault &fault, std::int64_t a, std::int64_t b) {
  constexpr std::int64_t exact = std::int64_t{1} << 53U;
  if (b == 0) {
    fault.fail("division by zero");
    return 0.0;
  }
  if (a >= -exact && a <= exact && b >= -exact && b <= exact) {
    return real(a) / real(b);
  }
  const auto size = [](std::int64_t n) {
    return n < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(n) : static_cast<std::uint64_t>(n);
  };
  std::uint64_t quotient = size(a) / size(b);
  std::uint64_t rest = size(a) % size(b);
  int exponent = 0;
  // The loop computes more binary digits than a float has. The last digit is then set to 1 if the
  // rest of the quotient is not zero, so the conversion to double rounds correctly.
  while (quotient >> 55U == 0 && exponent > -128) {
    const bool carry = rest >= size(b) - rest;
    rest = carry ? rest - (size(b) - rest) : rest + rest;
    quotient = quotient * 2 + (carry ? 1 : 0);
    --exponent;
  }
  const double result = std::ldexp(static_cast<double>(quotient | (rest != 0 ? 1U : 0U)), exponent);
  return (a < 0) != (b < 0) ? -result : result;
}

template <class Fault> double modulo(Fault &fault, double a, double b) {
  if (b == 0.0) {
    fault.fail("division by zero");
    return 0.0;
  }
  const double rest = std::fmod(a, b);
  if (rest == 0.0) {
    return std::copysign(0.0, b);
  }
  return (b < 0.0) != (rest < 0.0) ? rest + b : rest;
}

template <class Fault> double floor_divide(Fault &fault, double a, double b) {
  if (b == 0.0) {
    fault.fail("division by zero");
    return 0.0;
  }
  const double rest = std::fmod(a, b);
  double quotient = (a - rest) / b;
  if (rest != 0.0 && (b < 0.0) != (rest < 0.0)) {
    quotient -= 1.0;
  }
  if (quotient == 0.0) {
    return std::copysign(0.0, a / b);
  }
  const double down = std::floor(quotient);
  return quotient - down > 0.5 ? down + 1.0 : down;
}

/// A power of a whole number. A fault if the exponent is negative.
template <class Fault> std::int64_t power(Fault &fault, std::int64_t base, std::int64_t exponent) {
  if (exponent < 0) {
    fault.fail("a negative power of a whole number");
  }
  std::int64_t result = 1;
  for (std::int64_t square = base; exponent > 0; square = multiply(fault, square, square)) {
    if (exponent % 2 != 0) {
      result = multiply(fault, result, square);
    }
    exponent /= 2;
    if (exponent == 0) {
      break;
    }
  }
  return result;
}

template <class Fault> double power(Fault &fault, double base, double exponent) {
  const bool finite = std::isfinite(base) && std::isfinite(exponent);
  if (finite && base == 0.0 && exponent < 0.0) {
    fault.fail("a negative power of zero");
    return 0.0;
  }
  if (finite && base < 0.0 && exponent != std::floor(exponent)) {
    fault.fail("a broken power of a negative number, which is complex");
    return 0.0;
  }
  const double result = std::pow(base, exponent);
  if (finite && std::isinf(result)) {
    fault.fail("a power too large for a float");
  }
  return result;
}

/// A float without its fraction, as a whole number. A fault if it does not fit in 64 bits.
template <class Fault> std::int64_t whole(Fault &fault, double value) {
  if (!(value >= -detail::beyond_whole && value < detail::beyond_whole)) {
    fault.fail("a float that is no whole number of 64 bits");
    return 0;
  }
  return static_cast<std::int64_t>(value);
}

/// The nearest whole number; if two are equally near, the even one. A fault if it does not fit in
/// 64 bits.
template <class Fault> std::int64_t round(Fault &fault, double value) {
  return whole(fault, std::nearbyint(value));
}

// Truth and order

template <class T> bool truth(const T &value) {
  if constexpr (std::is_arithmetic_v<T>) {
    return value != T{};
  } else if constexpr (detail::is_optional<T>::value) {
    return value.has_value() && truth(*value);
  } else if constexpr (std::is_same_v<T, None>) {
    return false;
  } else if constexpr (detail::is_text<T>::value || detail::is_list<T>::value ||
                       detail::is_dict<T>::value) {
    return !value.empty();
  } else {
    return true;
  }
}

enum class Order { less, equal, greater, none };

namespace inner {

template <class T> Order plain_order(const T &a, const T &b) {
  return a < b ? Order::less : b < a ? Order::greater : a == b ? Order::equal : Order::none;
}

/// The order of a whole number and a float; exact, also if no float is equal to the whole number.
inline Order mixed_order(std::int64_t a, double b) {
  if (std::isnan(b)) {
    return Order::none;
  }
  if (b >= detail::beyond_whole) {
    return Order::less;
  }
  if (b < -detail::beyond_whole) {
    return Order::greater;
  }
  const auto cut = static_cast<std::int64_t>(b);
  return a != cut ? plain_order(a, cut) : plain_order(0.0, b - real(cut));
}

/// The order of two numbers.
template <class A, class B> Order number_order(const A &a, const B &b) {
  if constexpr (std::is_integral_v<A> && std::is_integral_v<B>) {
    return plain_order<std::int64_t>(a, b);
  } else if constexpr (std::is_integral_v<A>) {
    return mixed_order(a, b);
  } else if constexpr (std::is_integral_v<B>) {
    const Order found = mixed_order(b, a);
    return found == Order::less ? Order::greater : found == Order::greater ? Order::less : found;
  } else {
    return plain_order(a, b);
  }
}

} // namespace inner

/// `==` of Python. Values of types without a common value are not equal.
template <class A, class B> bool equal(const A &a, const B &b) {
  if constexpr (std::is_arithmetic_v<A> && std::is_arithmetic_v<B>) {
    return inner::number_order(a, b) == Order::equal;
  } else if constexpr (detail::is_optional<A>::value && detail::is_optional<B>::value) {
    return a.has_value() && b.has_value() ? equal(*a, *b) : a.has_value() == b.has_value();
  } else if constexpr (detail::is_optional<A>::value) {
    return a.has_value() ? equal(*a, b) : std::is_same_v<B, None>;
  } else if constexpr (detail::is_optional<B>::value) {
    return equal(b, a);
  } else if constexpr (detail::is_list<A>::value && detail::is_list<B>::value) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) {
      same = equal(a[i], b[i]);
    }
    return same;
  } else if constexpr (detail::is_dict<A>::value && detail::is_dict<B>::value) {
    bool same = a.size() == b.size();
    for (auto one = a.begin(), end = a.end(); same && one != end; ++one) {
      const auto other = b.find(one->first);
      same = other != b.end() && equal(one->second, other->second);
    }
    return same;
  } else if constexpr (std::is_same_v<A, B> && Fields<A>::value) {
    bool same = true;
    detail::each_pair(
        Fields<A>::members(a), Fields<A>::members(b),
        [&same](const auto &one, const auto &other) { same = same && equal(one, other); },
        std::make_index_sequence<detail::count_fields<A>()>());
    return same;
  } else if constexpr (std::is_same_v<A, B> ||
                       (detail::is_text<A>::value && detail::is_text<B>::value)) {
    return a == b;
  } else {
    return false;
  }
}

/// The order of two values; Order::none if one of the floats that decide it is NaN.
template <class Fault, class A, class B> Order order(Fault &fault, const A &a, const B &b) {
  if constexpr (std::is_arithmetic_v<A> && std::is_arithmetic_v<B>) {
    return inner::number_order(a, b);
  } else if constexpr (detail::is_text<A>::value && detail::is_text<B>::value) {
    return inner::plain_order(a.compare(b), 0);
  } else if constexpr (std::is_same_v<A, None> || std::is_same_v<B, None>) {
    fault.fail("None where a value is needed");
    return Order::none;
  } else if constexpr (detail::is_optional<A>::value) {
    return order(fault, present(fault, a), b);
  } else if constexpr (detail::is_optional<B>::value) {
    return order(fault, a, present(fault, b));
  } else {
    const std::size_t both = a.size() < b.size() ? a.size() : b.size();
    for (std::size_t i = 0; i < both; ++i) {
      if (!equal(a[i], b[i])) {
        return order(fault, a[i], b[i]);
      }
    }
    return inner::plain_order(a.size(), b.size());
  }
}

template <class Fault, class A, class B> bool less(Fault &fault, const A &a, const B &b) {
  return order(fault, a, b) == Order::less;
}

template <class Fault, class A, class B> bool at_most(Fault &fault, const A &a, const B &b) {
  const Order found = order(fault, a, b);
  return found == Order::less || found == Order::equal;
}

// Sequences

/// The number of the items of a list, or of the code points of a text.
template <class T> std::int64_t length(const T &items) {
  if constexpr (detail::is_text<T>::value) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      count += detail::is_start(items[i]) ? 1 : 0;
    }
    return count;
  } else {
    return static_cast<std::int64_t>(items.size());
  }
}

namespace inner {

/// The offset from the start for an index; a negative index counts from the end. A fault if the
/// index is out of range.
template <class Fault> std::size_t place(Fault &fault, std::int64_t index, std::int64_t size) {
  const std::int64_t found = index < 0 ? index + size : index;
  if (found < 0 || found >= size) {
    fault.fail("an index out of range");
    return 0;
  }
  return static_cast<std::size_t>(found);
}

struct itself {
  template <class T> const T &operator()(const T &value) const { return value; }
};

} // namespace inner

template <class Fault> double item(Fault &fault, const Point &point, std::int64_t index) {
  return std::array<double, 3>{point.x, point.y, point.z}[inner::place(fault, index, 3)];
}

template <class Fault> double item(Fault &fault, const Quaternion &q, std::int64_t index) {
  return std::array<double, 4>{q.x, q.y, q.z, q.w}[inner::place(fault, index, 4)];
}

/// Whether a list contains a value.
template <class T, class U> bool contains(const T &items, const U &value) {
  bool found = false;
  for (std::size_t i = 0; !found && i < items.size(); ++i) {
    found = equal(items[i], value);
  }
  return found;
}

/// The sum of `start` and all items: a whole number if all of them are whole numbers, otherwise a
/// float.
template <class Fault, class T, class S> auto sum(Fault &fault, const T &items, S start) {
  using Item = typename T::value_type;
  if constexpr (std::is_integral_v<Item> && std::is_integral_v<S>) {
    std::int64_t total = start;
    for (std::size_t i = 0; i < items.size(); ++i) {
      total = add(fault, total, items[i]);
    }
    return total;
  } else {
    auto total = static_cast<double>(start);
    for (std::size_t i = 0; i < items.size(); ++i) {
      total += static_cast<double>(items[i]);
    }
    return total;
  }
}

/// The index of the first item with the greatest key, or with the least one if `down` is true. A
/// fault if there are no items.
template <class Fault, class T, class F>
std::size_t extreme(Fault &fault, const T &items, F key, bool down) {
  std::size_t best = 0;
  if (items.size() == 0) {
    fault.fail(down ? "the least of nothing" : "the greatest of nothing");
    return best;
  }
  static_cast<void>(key(items[0])); // the key of a single item may have an error
  for (std::size_t i = 1; i < items.size(); ++i) {
    const bool better = down ? less(fault, key(items[i]), key(items[best]))
                             : less(fault, key(items[best]), key(items[i]));
    best = better ? i : best;
  }
  return best;
}

} // namespace checked

} // namespace v0_1_0
} // namespace smachac

#endif // SMACHAC_OPERATIONS_HPP
