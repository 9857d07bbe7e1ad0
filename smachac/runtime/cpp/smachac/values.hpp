// Made by smachac, as it is for every machine: do not edit.
//
// The values of userdata and the operations of Python on them, in C++17 without dependencies.
//
// The namespace `smachac` has the types and conversions, `smachac::py` the operations of Python.
// Whole numbers have 64 bits and every operation checks its result; Python has no limit. `//` and
// `%` round down. Texts are UTF-8, and their length is the number of code points. A smachac::Error
// is thrown where Python raises an exception, and where C++ cannot represent the result.
//
// Compile with -ffp-contract=off for processors with fused multiply-add, and never with
// -ffast-math: then floats are equal to those of Python to the last bit.
#ifndef SMACHAC_VALUES_HPP
#define SMACHAC_VALUES_HPP

#include <algorithm>
#include <any>
#include <array>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "smachac/operations.hpp"

namespace smachac {
inline namespace v0_1_0 {

/// The error of an expression without a value, with the reason as message.
struct Error : std::exception {
  explicit Error(std::string text) : message(std::move(text)) {}
  const char *what() const noexcept override { return message.c_str(); }
  std::string message;
};

/// Throws an Error. In a program without exceptions: prints the message and ends the program.
[[noreturn]] inline void fail(const char *message) {
#if defined(__cpp_exceptions)
  throw Error(message);
#else
  std::fputs("smachac: ", stderr);
  std::fputs(message, stderr);
  std::fputs("\n", stderr);
  std::abort();
#endif
}

/// A pose in the frame `frame_id`. The stamp is in seconds.
struct PoseStamped {
  std::string frame_id{};
  double stamp = 0.0;
  Pose pose{};
  friend bool operator==(const PoseStamped &a, const PoseStamped &b) {
    return a.frame_id == b.frame_id && a.stamp == b.stamp && a.pose == b.pose;
  }
  friend bool operator!=(const PoseStamped &a, const PoseStamped &b) { return !(a == b); }
};

/// The state of joints. `name` has the names of the joints; each other list is empty or has the
/// same length as `name`.
struct JointState {
  std::vector<std::string> name{};
  std::vector<double> position{}, velocity{}, effort{};
  friend bool operator==(const JointState &a, const JointState &b) {
    return a.name == b.name && a.position == b.position && a.velocity == b.velocity &&
           a.effort == b.effort;
  }
  friend bool operator!=(const JointState &a, const JointState &b) { return !(a == b); }
};

namespace detail {

template <class T> struct is_list<std::vector<T>> : std::true_type {};
template <class T> struct is_dict<std::map<std::string, T>> : std::true_type {};
template <> struct is_text<std::string> : std::true_type {};

/// The fault of an operation in a blocking machine: an exception.
struct Throwing {
  [[noreturn]] void fail(const char *message) const { smachac::fail(message); }
};
inline constexpr Throwing throwing{};

inline bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

} // namespace detail

namespace py {

template <class T> const T &present(const std::optional<T> &value) {
  if (!value.has_value()) {
    fail("None where a value is needed");
  }
  return *value;
}

using checked::real;
inline double widen(std::int64_t value) { return checked::widen(detail::throwing, value); }

} // namespace py

template <class To, class From> To convert(const From &from);

namespace detail {

/// A value as a std::any with the types of script values: lists are std::vector<std::any>, mappings
/// std::map<std::string, std::any>, whole numbers std::int64_t. None and an empty optional are an
/// empty std::any.
template <class From> std::any anything([[maybe_unused]] const From &from) {
  if constexpr (std::is_same_v<From, None>) {
    return std::any();
  } else if constexpr (is_optional<From>::value) {
    return from.has_value() ? anything(*from) : std::any();
  } else if constexpr (std::is_integral_v<From> && !std::is_same_v<From, bool>) {
    return std::any(static_cast<std::int64_t>(from));
  } else if constexpr (is_list<From>::value) {
    return std::any(convert<std::vector<std::any>>(from));
  } else if constexpr (is_dict<From>::value) {
    return std::any(convert<std::map<std::string, std::any>>(from));
  } else if constexpr (Fields<From>::value) {
    std::map<std::string, std::any> found;
    each_field(from, [&found](const char *name, const auto &member) {
      std::any value = anything(member);
      if (value.has_value()) {
        found.emplace(name, std::move(value));
      }
    });
    return std::any(std::move(found));
  } else {
    return std::any(from);
  }
}

} // namespace detail

/// The conversion of a value to another type: a whole number to a float, a list to an array of its
/// length, a value to an optional, an optional to its value, any value to a std::any; items of
/// lists and mappings likewise. Throws an Error if an optional is empty, if a list has another
/// length than the array, or if no float is equal to a whole number.
template <class To, class From> To convert([[maybe_unused]] const From &from) {
  if constexpr (std::is_same_v<To, From>) {
    return from;
  } else if constexpr (std::is_same_v<To, std::any>) {
    return detail::anything(from);
  } else if constexpr (detail::is_optional<From>::value && !detail::is_optional<To>::value) {
    return convert<To>(py::present(from));
  } else if constexpr (detail::is_optional<From>::value) {
    return from.has_value() ? To(convert<typename To::value_type>(*from)) : To();
  } else if constexpr (detail::is_optional<To>::value && std::is_same_v<From, None>) {
    return To();
  } else if constexpr (detail::is_optional<To>::value) {
    return To(convert<typename To::value_type>(from));
  } else if constexpr (std::is_same_v<To, double> && std::is_integral_v<From>) {
    return py::widen(from);
  } else if constexpr (std::is_same_v<To, Point> && detail::is_list<From>::value) {
    const auto found = convert<std::array<double, 3>>(from);
    return Point{found[0], found[1], found[2]};
  } else if constexpr (std::is_same_v<To, Quaternion> && detail::is_list<From>::value) {
    const auto found = convert<std::array<double, 4>>(from);
    return Quaternion{found[0], found[1], found[2], found[3]};
  } else if constexpr (detail::is_array<To>::value && detail::is_list<From>::value) {
    To result{};
    if (from.size() != result.size()) {
      fail("a list of another length than its type says");
    }
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = convert<typename To::value_type, typename From::value_type>(from[i]);
    }
    return result;
  } else if constexpr (detail::is_list<To>::value && detail::is_list<From>::value) {
    To result;
    result.reserve(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      result.push_back(convert<typename To::value_type, typename From::value_type>(from[i]));
    }
    return result;
  } else if constexpr (detail::is_dict<To>::value && detail::is_dict<From>::value) {
    To result;
    for (const auto &entry : from) {
      result.emplace(entry.first, convert<typename To::mapped_type>(entry.second));
    }
    return result;
  } else if constexpr (std::is_integral_v<To> && std::is_integral_v<From>) {
    return static_cast<To>(from);
  } else {
    // Here an empty list has items of a number type, while items of another type are expected. So
    // this branch must compile; an empty list has no item to convert.
    fail("a value of another type");
  }
}

namespace py {

/// A field of a record.
template <class T> const T &field(const T &member) { return member; }

/// A record with these values of its fields, converted, in the order of `Fields<T>::names`.
template <class T, class... Values> T made(const Values &...values) {
  T found{};
  detail::each_pair(
      Fields<T>::members(found), std::tie(values...),
      [](auto &member, const auto &value) {
        member = convert<std::decay_t<decltype(member)>>(value);
      },
      std::make_index_sequence<sizeof...(Values)>());
  return found;
}

using checked::equal;
using checked::length;
using checked::truth;
using checked::with;

// Arithmetic

inline std::int64_t add(std::int64_t a, std::int64_t b) {
  return checked::add(detail::throwing, a, b);
}
inline std::int64_t subtract(std::int64_t a, std::int64_t b) {
  return checked::subtract(detail::throwing, a, b);
}
inline std::int64_t multiply(std::int64_t a, std::int64_t b) {
  return checked::multiply(detail::throwing, a, b);
}
inline std::int64_t negate(std::int64_t a) { return checked::negate(detail::throwing, a); }
inline std::int64_t absolute(std::int64_t a) { return checked::absolute(detail::throwing, a); }
inline double absolute(double a) { return checked::absolute(detail::throwing, a); }
inline std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  return checked::floor_divide(detail::throwing, a, b);
}
inline double floor_divide(double a, double b) {
  return checked::floor_divide(detail::throwing, a, b);
}
inline std::int64_t modulo(std::int64_t a, std::int64_t b) {
  return checked::modulo(detail::throwing, a, b);
}
inline double modulo(double a, double b) { return checked::modulo(detail::throwing, a, b); }
inline double divide(std::int64_t a, std::int64_t b) {
  return checked::divide(detail::throwing, a, b);
}
inline double divide(double a, double b) { return checked::divide(detail::throwing, a, b); }
inline std::int64_t power(std::int64_t base, std::int64_t exponent) {
  return checked::power(detail::throwing, base, exponent);
}
inline double power(double base, double exponent) {
  return checked::power(detail::throwing, base, exponent);
}
inline std::int64_t whole(double value) { return checked::whole(detail::throwing, value); }
inline std::int64_t round(double value) { return checked::round(detail::throwing, value); }

/// A float rounded to a number of decimal places. `digits` must not be negative.
inline double round(double value, int digits) {
  if (!std::isfinite(value) || digits > 323) {
    return value;
  }
  char buffer[700];
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  return std::strtod(buffer, nullptr);
}

template <class A, class B> bool less(const A &a, const B &b) {
  return checked::less(detail::throwing, a, b);
}
template <class A, class B> bool at_most(const A &a, const B &b) {
  return checked::at_most(detail::throwing, a, b);
}

// Lists, mappings, texts

/// The greatest length of a list (items) or text (code points) that `range` and `*` make.
constexpr std::int64_t largest = 100'000;

namespace inner {

inline std::size_t place(std::int64_t index, std::int64_t size) {
  return checked::inner::place(detail::throwing, index, size);
}

} // namespace inner

inline std::vector<std::string> characters(const std::string &text) {
  std::vector<std::string> found;
  for (const char c : text) {
    if (detail::is_start(c) || found.empty()) {
      found.emplace_back();
    }
    found.back() += c;
  }
  return found;
}

/// The keys of a mapping, sorted. Python lists them in the order of insertion.
template <class T> std::vector<std::string> keys(const std::map<std::string, T> &entries) {
  std::vector<std::string> found;
  for (const auto &entry : entries) {
    found.push_back(entry.first);
  }
  return found;
}

template <class T> decltype(auto) item(const T &items, std::int64_t index) {
  return items[inner::place(index, length(items))];
}

inline std::string item(const std::string &text, std::int64_t index) {
  return characters(text)[inner::place(index, length(text))];
}

inline double item(const Point &point, std::int64_t index) {
  return checked::item(detail::throwing, point, index);
}
inline double item(const Quaternion &q, std::int64_t index) {
  return checked::item(detail::throwing, q, index);
}

template <class T> const T &item(const std::map<std::string, T> &entries, const std::string &key) {
  const auto found = entries.find(key);
  if (found == entries.end()) {
    fail("a key that is not in the mapping");
  }
  return found->second;
}

inline bool contains(const std::string &text, const std::string &part) {
  return text.find(part) != std::string::npos;
}

template <class T> bool contains(const std::map<std::string, T> &entries, const std::string &key) {
  return entries.find(key) != entries.end();
}

/// None is a key of no mapping.
template <class T>
bool contains(const std::map<std::string, T> &entries, const std::optional<std::string> &key) {
  return key.has_value() && entries.find(*key) != entries.end();
}

template <class T, class U> bool contains(const T &items, const U &value) {
  return checked::contains(items, value);
}

/// The concatenation of two lists.
template <class T, class A, class B> std::vector<T> concat(const A &a, const B &b) {
  auto result = convert<std::vector<T>>(a);
  for (std::size_t i = 0; i < b.size(); ++i) {
    result.push_back(convert<T, typename B::value_type>(b[i]));
  }
  return result;
}

namespace inner {

inline void limit(std::int64_t size, std::int64_t times) {
  if (times > 0 && size > largest / times) {
    fail("more than 100000 items or characters");
  }
}

} // namespace inner

inline std::string repeat(const std::string &text, std::int64_t times) {
  inner::limit(length(text), times);
  std::string result;
  for (std::int64_t i = 0; i < times && !text.empty(); ++i) {
    result += text;
  }
  return result;
}

template <class T> std::vector<typename T::value_type> repeat(const T &items, std::int64_t times) {
  inner::limit(length(items), times);
  std::vector<typename T::value_type> result;
  for (std::int64_t i = 0; i < times && !items.empty(); ++i) {
    result.insert(result.end(), items.begin(), items.end());
  }
  return result;
}

inline std::vector<std::int64_t> range(std::int64_t from, std::int64_t to, std::int64_t step = 1) {
  if (step == 0) {
    fail("a range with the step zero");
  }
  std::vector<std::int64_t> result;
  std::int64_t next = from;
  while (step > 0 ? next < to : next > to) {
    if (length(result) == largest) {
      fail("more than 100000 items or characters");
    }
    result.push_back(next);
    if (__builtin_add_overflow(next, step, &next)) {
      break;
    }
  }
  return result;
}

inline std::vector<std::int64_t> range(std::int64_t to) { return range(0, to); }

template <class T, class S> auto sum(const T &items, S start) {
  return checked::sum(detail::throwing, items, start);
}
template <class T> auto sum(const T &items) { return sum(items, 0); }

namespace inner {

using checked::inner::itself;

/// Throws an Error if a value contains a NaN: such values have no order.
template <class T> void check_order(const T &value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(value)) {
      fail("nan has no place in an order");
    }
  } else if constexpr (detail::is_list<T>::value) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      check_order(value[i]);
    }
  }
}

} // namespace inner

/// The first item with the greatest key. Throws an Error if there are no items.
template <class T, class F = inner::itself>
typename T::value_type max_of(const T &items, F key = {}) {
  return items[checked::extreme(detail::throwing, items, key, false)];
}

/// The first item with the least key. Throws an Error if there are no items.
template <class T, class F = inner::itself>
typename T::value_type min_of(const T &items, F key = {}) {
  return items[checked::extreme(detail::throwing, items, key, true)];
}

/// The items sorted by their keys. The sort is stable: items with equal keys keep their order.
/// Throws an Error if a key contains a NaN.
template <class T, class F = inner::itself>
auto sorted(const T &items, bool reverse = false, F key = {}) {
  using Item = typename T::value_type;
  std::vector<Item> result(items.begin(), items.end());
  for (const Item &each : items) {
    inner::check_order(key(each));
  }
  std::stable_sort(result.begin(), result.end(), [&](const Item &a, const Item &b) {
    return reverse ? less(key(b), key(a)) : less(key(a), key(b));
  });
  return result;
}

// Texts and numbers

inline std::string text(double value) {
  if (!std::isfinite(value)) {
    return std::isnan(value) ? "nan" : value < 0.0 ? "-inf" : "inf";
  }
  char buffer[40];
  const auto scientific = std::chars_format::scientific;
  const auto made = std::to_chars(buffer, buffer + sizeof buffer, value, scientific);
  const std::string_view found(buffer, static_cast<std::size_t>(made.ptr - buffer));
  const std::size_t letter = found.find('e');
  const int exponent = std::atoi(std::string(found.substr(letter + 1)).c_str());
  if (exponent < -4 || exponent >= 16) {
    return std::string(found);
  }
  std::string sign = found[0] == '-' ? "-" : "";
  std::string digits;
  for (const char c : found.substr(0, letter)) {
    if (detail::is_digit(c)) {
      digits += c;
    }
  }
  if (exponent < 0) {
    return sign + "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  }
  const std::size_t point = static_cast<std::size_t>(exponent) + 1;
  digits.resize(std::max(digits.size(), point + 1), '0');
  return sign + digits.substr(0, point) + "." + digits.substr(point);
}

namespace inner {

/// The notation of a written value: that of Python's `repr`, or JSON.
enum class Style { python, json };

/// Appends the `repr` of a text. Characters beyond ASCII are not escaped.
inline void write_quoted(std::string &out, const std::string &value) {
  const bool twice = contains(value, "'") && !contains(value, "\"");
  const char quote = twice ? '"' : '\'';
  out += quote;
  for (const char c : value) {
    if (c == quote || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n' || c == '\r' || c == '\t') {
      out += {'\\', c == '\n' ? 'n' : c == '\r' ? 'r' : 't'};
    } else if (static_cast<unsigned char>(c) < 0x20U || c == '\x7f') {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned>(c));
      out += escape;
    } else {
      out += c;
    }
  }
  out += quote;
}

inline void write_unit(std::string &out, std::uint32_t unit) {
  char escape[8];
  std::snprintf(escape, sizeof escape, "\\u%04" PRIx32, unit & 0xFFFFU);
  out += escape;
}

/// Appends a text as JSON. Characters beyond ASCII are escaped.
inline void write_json(std::string &out, const std::string &value) {
  constexpr std::string_view special = "\"\\\n\r\t\b\f", letters = "\"\\nrtbf";
  out += '"';
  for (std::size_t place = 0; place < value.size();) {
    const std::uint32_t point = detail::code_point(value, place);
    const auto c = static_cast<char>(point & 0x7FU);
    const auto which = point < 0x80U ? special.find(c) : std::string_view::npos;
    if (which != std::string_view::npos) {
      out += {'\\', letters[which]};
    } else if (point >= 0x10000U) {
      write_unit(out, 0xD800U + ((point - 0x10000U) >> 10U));
      write_unit(out, 0xDC00U + ((point - 0x10000U) & 0x3FFU));
    } else if (point < 0x20U || point > 0x7eU) {
      write_unit(out, point);
    } else {
      out += c;
    }
  }
  out += '"';
}

/// Appends a list of the parts. Returns as `write` does.
template <Style style, class... Parts> bool write_parts(std::string &out, const Parts &...parts);

/// Appends one entry of a mapping. Returns as `write` does.
template <Style style, class T>
bool write_entry(std::string &out, const char *before, const std::string &key, const T &value);

/// Appends the value in a std::any, or None if its type is not a type of script values. Returns as
/// `write` does.
template <Style style> bool write_any(std::string &out, const std::any &value);

/// Appends a value. Returns false if it contains a NaN or an infinity, which JSON cannot represent.
template <Style style, class T> bool write(std::string &out, const T &value) {
  constexpr bool python = style == Style::python;
  bool fine = true;
  if constexpr (std::is_same_v<T, bool>) {
    out += value ? (python ? "True" : "true") : (python ? "False" : "false");
  } else if constexpr (std::is_integral_v<T>) {
    out += std::to_string(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    out += text(value);
    fine = std::isfinite(value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    python ? write_quoted(out, value) : write_json(out, value);
  } else if constexpr (std::is_same_v<T, None>) {
    out += python ? "None" : "null";
  } else if constexpr (detail::is_optional<T>::value) {
    return value.has_value() ? write<style>(out, *value) : write<style>(out, None{});
  } else if constexpr (detail::is_dict<T>::value) {
    const char *before = "{";
    for (const auto &entry : value) {
      fine = write_entry<style>(out, before, entry.first, entry.second) && fine;
      before = ", ";
    }
    out += value.empty() ? "{}" : "}";
  } else if constexpr (detail::is_list<T>::value) {
    out += '[';
    for (std::size_t i = 0; i < value.size(); ++i) {
      out += i == 0 ? "" : ", ";
      fine = write<style, typename T::value_type>(out, value[i]) && fine;
    }
    out += ']';
  } else if constexpr (std::is_same_v<T, Point>) {
    return write_parts<style>(out, value.x, value.y, value.z);
  } else if constexpr (std::is_same_v<T, Quaternion>) {
    return write_parts<style>(out, value.x, value.y, value.z, value.w);
  } else if constexpr (std::is_same_v<T, Pose>) {
    return write_parts<style>(out, value.position, value.orientation);
  } else if constexpr (std::is_same_v<T, Transform>) {
    return write_parts<style>(out, value.translation, value.rotation);
  } else if constexpr (std::is_same_v<T, PoseStamped>) {
    fine = write_entry<style>(out, "{", "frame_id", value.frame_id);
    fine = write_entry<style>(out, ", ", "pose", value.pose) && fine;
    fine = write_entry<style>(out, ", ", "stamp", value.stamp) && fine;
    out += '}';
  } else if constexpr (std::is_same_v<T, JointState>) {
    fine = write_entry<style>(out, "{", "effort", value.effort);
    fine = write_entry<style>(out, ", ", "name", value.name) && fine;
    fine = write_entry<style>(out, ", ", "position", value.position) && fine;
    fine = write_entry<style>(out, ", ", "velocity", value.velocity) && fine;
    out += '}';
  } else if constexpr (Fields<T>::value) {
    const char *before = "{";
    detail::each_field(value, [&](const char *name, const auto &member) {
      if constexpr (detail::is_optional<std::decay_t<decltype(member)>>::value) {
        if (!member.has_value()) {
          return;
        }
      }
      fine = write_entry<style>(out, before, name, member) && fine;
      before = ", ";
    });
    out += before[0] == '{' ? "{}" : "}";
  } else if constexpr (Opaque<T>::value) {
    return write<style>(out, None{});
  } else {
    static_assert(std::is_same_v<T, std::any>, "smachac cannot write values of this type");
    fine = write_any<style>(out, value);
  }
  return fine;
}

template <Style style, class... Parts> bool write_parts(std::string &out, const Parts &...parts) {
  const char *before = "[";
  bool fine = true;
  ((out += before, fine = write<style>(out, parts) && fine, before = ", "), ...);
  out += ']';
  return fine;
}

template <Style style, class T>
bool write_entry(std::string &out, const char *before, const std::string &key, const T &value) {
  out += before;
  write<style>(out, key);
  out += ": ";
  return write<style>(out, value);
}

template <Style style> bool write_any(std::string &out, const std::any &value) {
  bool fine = true;
  const auto write_as = [&](const auto *found) {
    if (found != nullptr) {
      fine = write<style>(out, *found);
    }
    return found != nullptr;
  };
  if (!write_as(std::any_cast<bool>(&value)) && !write_as(std::any_cast<std::int64_t>(&value)) &&
      !write_as(std::any_cast<double>(&value)) && !write_as(std::any_cast<std::string>(&value)) &&
      !write_as(std::any_cast<std::vector<std::any>>(&value)) &&
      !write_as(std::any_cast<std::map<std::string, std::any>>(&value)) &&
      !write_as(std::any_cast<Point>(&value)) && !write_as(std::any_cast<Quaternion>(&value)) &&
      !write_as(std::any_cast<Pose>(&value)) && !write_as(std::any_cast<PoseStamped>(&value)) &&
      !write_as(std::any_cast<Transform>(&value)) && !write_as(std::any_cast<JointState>(&value))) {
    write<style>(out, None{});
  }
  return fine;
}

} // namespace inner

/// `repr` of Python. It is equal to `str` for every value except a text.
template <class T> std::string repr(const T &value) {
  std::string out;
  inner::write<inner::Style::python>(out, value);
  return out;
}

/// `str` of Python.
template <class T> std::string text(const T &value) {
  if constexpr (std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (detail::is_optional<T>::value) {
    return value.has_value() ? text(*value) : "None";
  } else {
    return repr(value);
  }
}

namespace inner {

/// The text of a number without the white space around it and without each `_` between two digits.
inline std::string number(const std::string &given) {
  std::size_t from = 0, to = given.size();
  while (from < to && detail::is_space(given[from])) {
    ++from;
  }
  while (to > from && detail::is_space(given[to - 1])) {
    --to;
  }
  std::string result;
  for (std::size_t i = from; i < to; ++i) {
    const bool between =
        i > from && i + 1 < to && detail::is_digit(given[i - 1]) && detail::is_digit(given[i + 1]);
    if (given[i] != '_' || !between) {
      result += given[i];
    }
  }
  return result;
}

/// Moves `place` behind the digits that start there. Returns their number.
inline std::size_t digits(std::string_view text, std::size_t &place) {
  const std::size_t from = place;
  while (place < text.size() && detail::is_digit(text[place])) {
    ++place;
  }
  return place - from;
}

/// Whether a text is a decimal number without a sign. For a number out of the range of a float,
/// `great` is true if the number is too large, false if it is too small.
inline bool is_decimal(std::string_view text, bool &great) {
  std::size_t place = 0;
  std::size_t count = digits(text, place);
  const std::size_t point = count;
  if (place < text.size() && text[place] == '.') {
    ++place;
    count += digits(text, place);
  }
  const std::size_t first = text.find_first_of("123456789");
  const std::size_t end = place;
  std::int64_t exponent = 0;
  if (count > 0 && place < text.size() && (text[place] == 'e' || text[place] == 'E')) {
    ++place;
    const bool down = place < text.size() && text[place] == '-';
    place += place < text.size() && (down || text[place] == '+') ? 1U : 0U;
    const std::size_t from = place;
    count = digits(text, place);
    for (std::size_t i = from; i < place && exponent < 1'000'000'000; ++i) {
      exponent = exponent * 10 + (text[i] - '0');
    }
    exponent = down ? -exponent : exponent;
  }
  if (first < end) {
    exponent += static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
    great = exponent > 0;
  }
  return count > 0 && place == text.size();
}

} // namespace inner

/// `int` of a text. Only the digits of ASCII are read. Throws an Error if the text is not a whole
/// number or the number does not fit in 64 bits.
inline std::int64_t whole(const std::string &given) {
  const std::string found = inner::number(given);
  std::size_t place = !found.empty() && (found[0] == '-' || found[0] == '+') ? 1 : 0;
  const bool minus = place == 1 && found[0] == '-';
  const std::size_t from = place;
  if (inner::digits(found, place) == 0 || place != found.size()) {
    fail("a text that is no whole number");
  }
  std::int64_t result = 0;
  for (std::size_t i = from; i < found.size(); ++i) {
    const std::int64_t digit = found[i] - '0';
    result = add(multiply(result, 10), minus ? -digit : digit);
  }
  return result;
}

/// `float` of a text. Only the digits of ASCII are read. Throws an Error if the text is not a
/// number.
inline double real(const std::string &given) {
  std::string found = inner::number(given);
  const bool minus = !found.empty() && found[0] == '-';
  if (minus || (!found.empty() && found[0] == '+')) {
    found.erase(0, 1);
  }
  std::string lower = found;
  for (char &c : lower) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  double result = 0.0;
  bool great = false;
  if (lower == "inf" || lower == "infinity") {
    result = HUGE_VAL;
  } else if (lower == "nan") {
    result = std::nan("");
  } else if (!inner::is_decimal(found, great)) {
    fail("a text that is no number");
  } else {
#if defined(__cpp_lib_to_chars)
    const auto read = std::from_chars(found.data(), found.data() + found.size(), result);
    if (read.ec != std::errc()) {
      result = great ? HUGE_VAL : 0.0;
    }
#else
    result = std::strtod(found.c_str(), nullptr);
#endif
  }
  return minus ? -result : result;
}

} // namespace py

/// A value as JSON for a trace, as Python's `json.dumps` writes it, with the entries of mappings
/// sorted by name. A value that contains a NaN or an infinity becomes a JSON string with its
/// `repr`.
template <class T> std::string json(const T &value) {
  std::string out;
  if (!py::inner::write<py::inner::Style::json>(out, value)) {
    out = "";
    py::inner::write_json(out, py::repr(value));
  }
  return out;
}

} // namespace v0_1_0
} // namespace smachac

#endif
