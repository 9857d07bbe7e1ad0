// Made by smachac, as it is for every machine: do not edit.
//
// The check of the fields of a class of the user against its interface, at compile time.
#ifndef SMACHAC_CLASS_CHECKS_HPP
#define SMACHAC_CLASS_CHECKS_HPP

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

namespace smachac {
inline namespace v0_1_0 {

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wundefined-var-template"
#endif

/// Two objects of the type T, for the check of the order of fields (`in_order`): a reference field
/// with the mark refers to `one`, a reference field without it to `other`. Both are declared and
/// never defined: only their addresses are compared, and only in constant expressions.
template <class T> struct Marks {
  static T one;
  static T other;
};

/// The initial value of a field of the type `T` with or without the mark: 1 or 0, or for a
/// reference `one` or `other` of Marks, for a text "1" or nothing.
template <class T> constexpr T with_mark(bool marked) {
  if constexpr (std::is_reference_v<T>) {
    using Object = std::remove_const_t<std::remove_reference_t<T>>;
    return marked ? Marks<Object>::one : Marks<Object>::other;
  } else if constexpr (std::is_arithmetic_v<T>) {
    return marked ? T(1) : T(0);
  } else {
    return marked ? T("1") : T("");
  }
}

template <class T> constexpr bool is_marked(const T &field) {
  if constexpr (std::is_arithmetic_v<T>) {
    return field == T(1);
  } else if constexpr (std::is_same_v<T, std::string_view>) {
    return !field.empty();
  } else {
    return &field == &Marks<T>::one;
  }
}

#if defined(__clang__)
#pragma clang diagnostic pop
#endif

/// The number of fields before the first field with the mark.
template <class... Fields> constexpr std::size_t before_mark(const Fields &...fields) {
  std::size_t count = 0;
  static_cast<void>((... || (is_marked(fields) || (++count, false))));
  return count;
}

template <std::size_t at, class Keys, class... Types, class Fields, std::size_t... all>
constexpr auto has_at(Fields fields, std::index_sequence<all...>)
    -> decltype(Keys{with_mark<Types>(all == at)...}, true) {
  return fields(Keys{with_mark<Types>(all == at)...}) == at;
}
template <std::size_t at, class Keys, class... Types, class Fields>
constexpr bool has_at(Fields, ...) {
  return false;
}
template <class Keys, class... Types, class Fields, std::size_t... all>
constexpr bool in_order(Fields fields, std::index_sequence<all...> each) {
  return (has_at<all, Keys, Types...>(fields, each) && ...);
}

/// Whether the fields of the class `Keys` have the types `Types` in this order and the names in the
/// expected order. `fields` takes an object of `Keys` and returns `before_mark` of its fields,
/// listed by name in the expected order. The check initializes `Keys` once for each field, with the
/// mark at that field.
template <class Keys, class... Types, class Fields> constexpr bool in_order(Fields fields) {
  return in_order<Keys, Types...>(fields, std::index_sequence_for<Types...>());
}

} // namespace v0_1_0
} // namespace smachac

#endif // SMACHAC_CLASS_CHECKS_HPP
