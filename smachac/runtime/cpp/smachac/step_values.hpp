// Made by smachac, as it is for every machine: do not edit.
//
// The values of stepped machines: texts and lists with a bound, userdata keys, and the operations
// of Python on them. Nothing allocates and nothing throws: an operation without a value keeps the
// reason in a Fault, and its result is not used.
#ifndef SMACHAC_STEP_VALUES_HPP
#define SMACHAC_STEP_VALUES_HPP

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#if __STDC_HOSTED__
#include <charconv>
#endif

#include "smachac/operations.hpp"

namespace smachac {
inline namespace v0_1_0 {
namespace step {

/// The first error of an operation: its reason, and the key that it is about, if there is one.
class Fault {
public:
  void fail(const char *message) {
    if (message_ == nullptr) {
      message_ = message;
    }
  }
  void fail(const char *message, const char *key) {
    if (message_ == nullptr) {
      key_ = key;
    }
    fail(message);
  }
  [[nodiscard]] bool has_failed() const { return message_ != nullptr; }
  /// The reason; a general one for a state that failed without one.
  [[nodiscard]] const char *message() const {
    return message_ != nullptr ? message_ : "ended with an error";
  }
  [[nodiscard]] const char *key() const { return key_; }
  void clear() { message_ = key_ = nullptr; }

private:
  const char *message_ = nullptr;
  const char *key_ = nullptr;
};

// Texts and lists

/// Whether a text or list of this program was ever given more than its bound. Until then, no output
/// is searched for one: a list of texts would cost each step some instructions for each text.
inline std::atomic<bool> any_went_over{false};

/// A text with a bound: at most `capacity()` bytes of UTF-8. Its storage is in a TextOf or a Key.
class Text {
public:
  Text(const Text &) = delete;
  ~Text() = default;

  [[nodiscard]] std::string_view view() const { return {data_, size_}; }
  operator std::string_view() const { return view(); } // NOLINT: `in.name == "left"`
  [[nodiscard]] const char *data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  char operator[](std::size_t i) const { return data_[i]; }
  char &operator[](std::size_t i) { return data_[i]; }

  /// Sets the text. Returns false and keeps the old text if the new one is longer than the bound:
  /// the state that does this in an output fails.
  bool assign(std::string_view text) {
    if (text.size() > capacity_) {
      return over();
    }
    size_ = 0;
    return append(text);
  }
  /// Appends a text, under the same condition.
  bool append(std::string_view text) {
    if (text.size() > static_cast<std::size_t>(capacity_ - size_)) {
      return over();
    }
    for (const char c : text) {
      data_[size_++] = c;
    }
    return true;
  }
  Text &operator=(std::string_view text) {
    assign(text);
    return *this;
  }
  /// A copy of a text that went over its bound counts as such a text too.
  Text &operator=(const Text &text) {
    if (this != &text) {
      assign(text.view());
      over_ = over_ || text.over_;
    }
    return *this;
  }
  /// Whether a text beyond the bound was assigned since the last call.
  bool went_over() { return std::exchange(over_, false); }
  [[nodiscard]] bool is_over() const { return over_; }

protected:
  Text(char *data, std::size_t capacity)
      : data_(data), capacity_(static_cast<std::uint16_t>(capacity)) {}

private:
  [[gnu::cold]] bool over() {
    over_ = true;
    any_went_over.store(true, std::memory_order_relaxed);
    return false;
  }

  char *data_;
  std::uint16_t size_ = 0;
  std::uint16_t capacity_;
  bool over_ = false;
};

/// A text of at most `N` bytes with its storage.
template <std::size_t N> class TextOf : public Text {
public:
  TextOf() : Text(storage_, N) {}
  TextOf(std::string_view text) : TextOf() { assign(text); }   // NOLINT: `TextOf<8> side{"left"}`
  TextOf(const char *text) : TextOf(std::string_view(text)) {} // NOLINT
  TextOf(const TextOf &text) : TextOf() { Text::operator=(text); }
  ~TextOf() = default;
  TextOf &operator=(const TextOf &text) {
    Text::operator=(text);
    return *this;
  }
  TextOf &operator=(const char *text) {
    assign(text);
    return *this;
  }
  using Text::operator=;

private:
  char storage_[N > 0 ? N : 1]{};
};

// Comparisons of texts; those with string literals and views use the same functions.
inline bool operator==(const Text &a, const Text &b) { return a.view() == b.view(); }
inline bool operator!=(const Text &a, const Text &b) { return a.view() != b.view(); }
inline bool operator==(const Text &a, std::string_view b) { return a.view() == b; }
inline bool operator!=(const Text &a, std::string_view b) { return a.view() != b; }
inline bool operator==(std::string_view a, const Text &b) { return a == b.view(); }
inline bool operator!=(std::string_view a, const Text &b) { return a != b.view(); }

/// A list with a bound: at most `capacity()` items. Its storage is in a ListOf or a Key.
template <class T> class List {
public:
  using value_type = T;

  List(const List &) = delete;
  ~List() = default;

  [[nodiscard]] const T *data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const T *begin() const { return data_; }
  [[nodiscard]] const T *end() const { return data_ + size_; }
  const T &operator[](std::size_t i) const { return data_[i]; }
  T &operator[](std::size_t i) { return data_[i]; }

  /// Appends an item. Returns false if the list is full: the state that does this in an output
  /// fails.
  bool push_back(const T &item) {
    if (size_ == capacity_) {
      return over();
    }
    data_[size_++] = item;
    return true;
  }
  void pop_back() { --size_; }
  /// Sets the item at an index below the capacity; `resize` makes it an item of the list.
  void replace(std::size_t i, const T &item) { data_[i] = item; }
  void resize(std::size_t size) { size_ = static_cast<std::uint16_t>(size); }
  void clear() { size_ = 0; }
  /// A copy of a list that went over its bound counts as such a list too.
  List &operator=(const List &list) {
    if (this != &list) {
      assign(list);
      over_ = over_ || list.over_;
    }
    return *this;
  }
  /// Sets all items from another sequence, which may have more of them than the bound.
  template <class Items> void assign(const Items &items) {
    if (items.size() > capacity_) {
      over();
      return;
    }
    size_ = 0;
    for (const auto &item : items) {
      data_[size_++] = item;
    }
  }
  /// Whether an item beyond the bound was added since the last call.
  bool went_over() { return std::exchange(over_, false); }
  [[nodiscard]] bool is_over() const { return over_; }

protected:
  List(T *data, std::size_t capacity)
      : data_(data), capacity_(static_cast<std::uint16_t>(capacity)) {}

private:
  [[gnu::cold]] bool over() {
    over_ = true;
    any_went_over.store(true, std::memory_order_relaxed);
    return false;
  }

  T *data_;
  std::uint16_t size_ = 0;
  std::uint16_t capacity_;
  bool over_ = false;
};

/// A list of at most `N` items with its storage.
template <class T, std::size_t N> class ListOf : public List<T> {
public:
  ListOf() : List<T>(storage_, N) {}
  ListOf(std::initializer_list<T> items) : ListOf() { this->assign(items); }
  ListOf(const ListOf &list) : ListOf() { List<T>::operator=(list); }
  ~ListOf() = default;
  ListOf &operator=(const ListOf &list) {
    List<T>::operator=(list);
    return *this;
  }

private:
  T storage_[N > 0 ? N : 1]{};
};

/// A pose in the frame `frame_id`, a text of at most `N` bytes. The stamp is in seconds.
template <std::size_t N> struct PoseStampedOf {
  TextOf<N> frame_id{};
  double stamp = 0.0;
  Pose pose{};
  friend bool operator==(const PoseStampedOf &a, const PoseStampedOf &b) {
    return a.frame_id == b.frame_id && a.stamp == b.stamp && a.pose == b.pose;
  }
  friend bool operator!=(const PoseStampedOf &a, const PoseStampedOf &b) { return !(a == b); }
};

template <class T> struct is_stamped : std::false_type {};
template <std::size_t N> struct is_stamped<PoseStampedOf<N>> : std::true_type {};

} // namespace step

namespace detail {

template <> struct is_text<std::string_view> : std::true_type {};
template <> struct is_text<step::Text> : std::true_type {};
template <std::size_t N> struct is_text<step::TextOf<N>> : std::true_type {};
template <class T> struct is_list<step::List<T>> : std::true_type {};
template <class T, std::size_t N> struct is_list<step::ListOf<T, N>> : std::true_type {};

} // namespace detail

namespace step {

/// Sets `to` to a value, converted: a whole number to a float, a list to a list or an array, a text
/// to a text, a value to an optional, an optional to its value. A fault if the value goes over a
/// bound, if an optional is empty, if an array has another length, or if no float is equal to a
/// whole number. Returns whether there was none.
template <class To, class From> bool put(Fault &fault, To &to, const From &from) {
  if constexpr (smachac::detail::is_text<To>::value) {
    if (!to.assign(from)) {
      to.went_over();
      fault.fail("a text beyond its bound");
    }
  } else if constexpr (std::is_same_v<To, From>) {
    to = from;
  } else if constexpr (smachac::detail::is_optional<From>::value &&
                       !smachac::detail::is_optional<To>::value) {
    if (!from.has_value()) {
      fault.fail("None where a value is needed");
      return false;
    }
    return put(fault, to, *from);
  } else if constexpr (smachac::detail::is_optional<From>::value) {
    to.reset();
    return !from.has_value() || put(fault, to.emplace(), *from);
  } else if constexpr (smachac::detail::is_optional<To>::value && std::is_same_v<From, None>) {
    to.reset();
  } else if constexpr (smachac::detail::is_optional<To>::value) {
    return put(fault, to.emplace(), from);
  } else if constexpr (std::is_same_v<To, double> && std::is_integral_v<From>) {
    to = checked::widen(fault, from);
  } else if constexpr (std::is_same_v<To, Point> || std::is_same_v<To, Quaternion>) {
    std::array<double, std::is_same_v<To, Point> ? 3 : 4> found{};
    put(fault, found, from);
    if constexpr (std::is_same_v<To, Point>) {
      to = {found[0], found[1], found[2]};
    } else {
      to = {found[0], found[1], found[2], found[3]};
    }
  } else if constexpr (smachac::detail::is_array<To>::value) {
    if (from.size() != to.size()) {
      fault.fail("a list of another length than its type says");
      return false;
    }
    for (std::size_t i = 0; i < to.size(); ++i) {
      put(fault, to[i], from[i]);
    }
  } else if constexpr (smachac::detail::is_list<To>::value) {
    if (from.size() > to.capacity()) {
      fault.fail("a list beyond its bound");
      return false;
    }
    // From the last item to the first, because a list can be extended at its beginning by itself.
    const std::size_t size = from.size();
    for (std::size_t i = size; i-- > 0;) {
      typename To::value_type found{};
      put(fault, found, from[i]);
      to.replace(i, found);
    }
    to.resize(size);
  } else {
    to = static_cast<To>(from);
  }
  return !fault.has_failed();
}

/// A value as a value of another type, as `put` converts it.
template <class To, class From> To convert(Fault &fault, const From &from) {
  To found{};
  put(fault, found, from);
  return found;
}

/// Whether a text or list in a value was given more than its bound since the last call.
template <class T> bool went_over(T &value) {
  if constexpr (smachac::detail::is_text<T>::value) {
    return value.is_over() && value.went_over();
  } else if constexpr (smachac::detail::is_array<T>::value || smachac::detail::is_list<T>::value) {
    bool found = false;
    if constexpr (!smachac::detail::is_array<T>::value) {
      found = value.is_over() && value.went_over();
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      found = went_over(value[i]) || found;
    }
    return found;
  } else if constexpr (smachac::detail::is_optional<T>::value) {
    return value.has_value() && went_over(*value);
  } else if constexpr (Fields<T>::value) {
    bool found = false;
    smachac::detail::each_field(
        value, [&found](const char *, auto &member) { found = went_over(member) || found; });
    return found;
  } else if constexpr (is_stamped<T>::value) {
    return went_over(value.frame_id);
  } else {
    return false;
  }
}

// Keys

namespace detail {

/// Whether a key is set, and whether a state has written it.
enum class KeyState : std::uint8_t { unset, held, written };

/// The functions that all keys share; `Own` has `value()`.
template <class Own, class T> class KeyOf {
public:
  [[nodiscard]] bool set() const { return state_ != KeyState::unset; }
  /// The value; in an unset key the default value of its type.
  [[nodiscard]] const T &get() const { return own().value(); }
  [[nodiscard]] const T &unchecked() const { return own().value(); }
  /// A reference to the value for a change in place. The key then counts as written.
  [[nodiscard]] T &edit() {
    state_ = KeyState::written;
    return own().value();
  }
  /// Whether a part of the value was given more than its bound since the last call.
  bool exceeded() { return step::went_over(own().value()); }
  /// Writes the value of a state.
  template <class U> void write(Fault &fault, const char *name, const U &value) {
    set_to(fault, name, value, KeyState::written);
  }
  /// Sets the value at the border of a container. This is not a write of a state.
  template <class U> void hold(Fault &fault, const char *name, const U &value) {
    set_to(fault, name, value, KeyState::held);
  }
  /// Copies the value of another key as `hold` does; does nothing if that key is unset.
  template <class Other> void take(Fault &fault, const char *name, const Other &other) {
    if (other.set()) {
      hold(fault, name, other.get());
    }
  }
  /// Whether a state has written the key since the last call. The call clears this mark.
  bool fresh() {
    const bool found = state_ == KeyState::written;
    if (found) {
      state_ = KeyState::held;
    }
    return found;
  }

protected:
  constexpr KeyOf() = default;
  constexpr explicit KeyOf(KeyState state) : state_(state) {}
  void mark(KeyState state = KeyState::written) { state_ = state; }

private:
  template <class U> void set_to(Fault &fault, const char *name, const U &value, KeyState state) {
    Fault own_fault;
    if (put(own_fault, own().value(), value)) {
      state_ = state;
    } else {
      fault.fail(own_fault.message(), name);
    }
  }
  [[nodiscard]] Own &own() { return static_cast<Own &>(*this); }
  [[nodiscard]] const Own &own() const { return static_cast<const Own &>(*this); }

  KeyState state_ = KeyState::unset;
};

} // namespace detail

/// A userdata key: a value that is set or unset.
template <class T> class Key : public detail::KeyOf<Key<T>, T> {
public:
  using value_type = T;

  constexpr Key() = default;
  constexpr Key(T value) // NOLINT: `Key<double> width{0.5}`
      : detail::KeyOf<Key<T>, T>(detail::KeyState::held), value_(std::move(value)) {}

  Key &operator=(const T &value) {
    value_ = value;
    this->mark();
    return *this;
  }
  operator const T &() const { return value_; } // NOLINT: `in.tries + 1`

private:
  template <class Own, class U> friend class detail::KeyOf;
  T &value() { return value_; }
  const T &value() const { return value_; }

  T value_{};
};

/// A userdata key with a text, whatever its bound.
template <> class Key<Text> : public detail::KeyOf<Key<Text>, Text>, public Text {
public:
  using value_type = Text;

  Key(const Key &) = delete;
  Key &operator=(const Key &) = delete;
  ~Key() = default;
  Key &operator=(std::string_view text) {
    assign(text);
    mark();
    return *this;
  }

protected:
  Key(char *data, std::size_t capacity) : Text(data, capacity) {}
  void start_with(std::string_view text) {
    assign(text);
    mark(detail::KeyState::held);
  }

private:
  template <class Own, class U> friend class detail::KeyOf;
  Text &value() { return *this; }
  [[nodiscard]] const Text &value() const { return *this; }
};

template <std::size_t N> class Key<TextOf<N>> : public Key<Text> {
public:
  Key() : Key<Text>(storage_, N) {}
  Key(std::string_view text) : Key() { this->start_with(text); } // NOLINT
  using Key<Text>::operator=;

private:
  char storage_[N > 0 ? N : 1]{};
};

/// A userdata key with a list, whatever its bound.
template <class T>
class Key<List<T>> : public detail::KeyOf<Key<List<T>>, List<T>>, public List<T> {
public:
  using value_type = List<T>;

  Key(const Key &) = delete;
  Key &operator=(const Key &) = delete;
  ~Key() = default;
  Key &operator=(const List<T> &list) {
    List<T>::assign(list);
    this->mark();
    return *this;
  }
  /// Appends an item: a write of a state.
  bool push_back(const T &item) {
    this->mark();
    return List<T>::push_back(item);
  }

protected:
  Key(T *data, std::size_t capacity) : List<T>(data, capacity) {}
  void start_with(const List<T> &list) {
    List<T>::assign(list);
    this->mark(detail::KeyState::held);
  }

private:
  template <class Own, class U> friend class detail::KeyOf;
  List<T> &value() { return *this; }
  [[nodiscard]] const List<T> &value() const { return *this; }
};

template <class T, std::size_t N> class Key<ListOf<T, N>> : public Key<List<T>> {
public:
  Key() : Key<List<T>>(storage_, N) {}
  Key(const ListOf<T, N> &list) : Key() { this->start_with(list); } // NOLINT
  using Key<List<T>>::operator=;

private:
  T storage_[N > 0 ? N : 1]{};
};

/// The value of a key that must be set. A fault with the name of the key if it is unset.
template <class K> [[nodiscard]] const auto &need(Fault &fault, const K &key, const char *name) {
  if (!key.set()) {
    fault.fail("reads a key that holds nothing", name);
  }
  return key.get();
}

/// The value of a key as an optional; empty if the key is unset.
template <class Optional, class K> [[nodiscard]] Optional maybe(Fault &fault, const K &key) {
  return key.set() ? convert<Optional>(fault, key.get()) : Optional();
}

// The operations of Python

namespace py {

using checked::absolute;
using checked::add;
using checked::at_most;
using checked::divide;
using checked::equal;
using checked::floor_divide;
using checked::length;
using checked::less;
using checked::modulo;
using checked::multiply;
using checked::negate;
using checked::power;
using checked::real;
using checked::round;
using checked::subtract;
using checked::sum;
using checked::truth;
using checked::whole;
using checked::widen;
using checked::with;

/// A value as expressions use it: a text as a view.
template <class T> decltype(auto) viewed(const T &value) {
  if constexpr (smachac::detail::is_text<T>::value) {
    return std::string_view(value);
  } else {
    return (value);
  }
}

/// A field of a record.
template <class T> decltype(auto) field(const T &member) { return viewed(member); }

/// A record with these values of its fields, as `put` converts them, in the order of
/// `Fields<T>::names`.
template <class T, class... Values> T made(Fault &fault, const Values &...values) {
  T found{};
  smachac::detail::each_pair(
      Fields<T>::members(found), std::tie(values...),
      [&fault](auto &member, const auto &value) { put(fault, member, value); },
      std::make_index_sequence<sizeof...(Values)>());
  return found;
}

template <class T> auto present(Fault &fault, const std::optional<T> &value) {
  if (!value.has_value()) {
    fault.fail("None where a value is needed");
  }
  if constexpr (smachac::detail::is_text<T>::value) {
    return value.has_value() ? std::string_view(*value) : std::string_view();
  } else {
    return value.has_value() ? *value : T{};
  }
}

template <class T> decltype(auto) item(Fault &fault, const T &items, std::int64_t index) {
  if constexpr (std::is_same_v<T, Point> || std::is_same_v<T, Quaternion>) {
    return checked::item(fault, items, index);
  } else {
    return viewed(items[checked::inner::place(fault, index, length(items))]);
  }
}

/// The code point at an index of a text.
inline std::string_view item(Fault &fault, std::string_view text, std::int64_t index) {
  std::size_t at = checked::inner::place(fault, index, length(text));
  std::size_t begin = 0;
  while (begin < text.size() && (!smachac::detail::is_start(text[begin]) || at-- > 0)) {
    ++begin;
  }
  std::size_t end = begin < text.size() ? begin + 1 : begin;
  while (end < text.size() && !smachac::detail::is_start(text[end])) {
    ++end;
  }
  return text.substr(begin, end - begin);
}

inline bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}
template <class T, class U>
std::enable_if_t<smachac::detail::is_list<T>::value, bool> contains(const T &items,
                                                                    const U &value) {
  return checked::contains(items, value);
}

template <class T> auto sum(Fault &fault, const T &items) { return checked::sum(fault, items, 0); }

template <class T, class F = checked::inner::itself>
decltype(auto) max_of(Fault &fault, const T &items, F key = {}) {
  return viewed(items[checked::extreme(fault, items, key, false)]);
}
template <class T, class F = checked::inner::itself>
decltype(auto) min_of(Fault &fault, const T &items, F key = {}) {
  return viewed(items[checked::extreme(fault, items, key, true)]);
}

/// The concatenation of two lists with items of the type `T`: it lives as long as the expression,
/// and `put` stores it.
template <class T, class A, class B> struct Concatenation {
  using value_type = T;

  const A &a;
  const B &b;

  [[nodiscard]] std::size_t size() const { return a.size() + b.size(); }
  [[nodiscard]] bool empty() const { return size() == 0; }
  T operator[](std::size_t i) const {
    return i < a.size() ? T(viewed(a[i])) : T(viewed(b[i - a.size()]));
  }
};
template <class T, class A, class B>
Concatenation<T, A, B> concat(Fault &, const A &a, const B &b) {
  return {a, b};
}

} // namespace py

} // namespace step

namespace detail {

template <class T, class A, class B>
struct is_list<step::py::Concatenation<T, A, B>> : std::true_type {};

} // namespace detail

namespace step {

// JSON

/// The receiver of the parts of a text.
struct Sink {
  void *self;
  void (*write)(void *self, const char *text, std::size_t size);

  void operator()(std::string_view text) const { write(self, text.data(), text.size()); }
};

/// Writes a whole number.
inline void write_number(const Sink &sink, std::int64_t value) {
  char buffer[20];
  std::size_t at = sizeof buffer;
  auto rest = static_cast<std::uint64_t>(value);
  rest = value < 0 ? std::uint64_t{0} - rest : rest;
  do {
    buffer[--at] = static_cast<char>('0' + rest % 10U);
    rest /= 10U;
  } while (rest > 0);
  if (value < 0) {
    sink("-");
  }
  sink({buffer + at, sizeof buffer - at});
}

/// Writes a text as it is between the quotes of JSON. Characters beyond ASCII are escaped.
inline void write_escaped(const Sink &sink, std::string_view value) {
  constexpr std::string_view special = "\"\\\n\r\t\b\f", letters = "\"\\nrtbf";
  constexpr char digits[] = "0123456789abcdef";
  const auto unit = [&](std::uint32_t code) {
    const char escape[] = {'\\',
                           'u',
                           digits[code >> 12U & 15U],
                           digits[code >> 8U & 15U],
                           digits[code >> 4U & 15U],
                           digits[code & 15U]};
    sink({escape, sizeof escape});
  };
  for (std::size_t place = 0; place < value.size();) {
    const std::size_t begin = place;
    const std::uint32_t point = smachac::detail::code_point(value, place);
    const auto which = point < 0x80U ? special.find(static_cast<char>(point)) : special.npos;
    if (which != special.npos) {
      const char escape[] = {'\\', letters[which]};
      sink({escape, sizeof escape});
    } else if (point >= 0x10000U) {
      unit(0xD800U + ((point - 0x10000U) >> 10U));
      unit(0xDC00U + ((point - 0x10000U) & 0x3FFU));
    } else if (point < 0x20U || point > 0x7eU) {
      unit(point);
    } else {
      sink(value.substr(begin, place - begin));
    }
  }
}

/// Writes a text as JSON.
inline void write_text(const Sink &sink, std::string_view value) {
  sink("\"");
  write_escaped(sink, value);
  sink("\"");
}

/// Writes a float as Python does; as `null` where the C++ library has no `std::to_chars` for it.
inline void write_float(const Sink &sink, double value) {
  if (!std::isfinite(value)) {
    sink(std::isnan(value) ? "\"nan\"" : value < 0.0 ? "\"-inf\"" : "\"inf\"");
    return;
  }
#if defined(__cpp_lib_to_chars)
  char buffer[40];
  const auto made =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific);
  std::string_view found(buffer, static_cast<std::size_t>(made.ptr - buffer));
  const std::size_t letter = found.find('e');
  int exponent = 0;
  for (const char c : found.substr(letter + 2)) {
    exponent = exponent * 10 + (c - '0');
  }
  exponent = found[letter + 1] == '-' ? -exponent : exponent;
  if (exponent < -4 || exponent >= 16) {
    sink(found);
    return;
  }
  if (found[0] == '-') {
    sink("-");
    found.remove_prefix(1);
  }
  char digits[20];
  std::size_t count = 0;
  for (const char c : found.substr(0, found.find('e'))) {
    if (c != '.') {
      digits[count++] = c;
    }
  }
  const auto digit = [&](std::size_t i) { sink({i < count ? digits + i : "0", 1}); };
  if (exponent < 0) {
    sink("0.");
    for (int i = 1; i < -exponent; ++i) {
      sink("0");
    }
    sink({digits, count});
    return;
  }
  const auto whole = static_cast<std::size_t>(exponent) + 1;
  for (std::size_t i = 0; i < whole; ++i) {
    digit(i);
  }
  sink(".");
  digit(whole);
  for (std::size_t i = whole + 1; i < count; ++i) {
    digit(i);
  }
#else
  sink("null");
#endif
}

/// Writes a value as JSON, as Python's `json.dumps` does.
template <class T> void write_json(const Sink &sink, const T &value) {
  const auto list = [&](const auto &...parts) {
    const char *before = "[";
    ((sink(before), write_json(sink, parts), before = ", "), ...);
    sink("]");
  };
  if constexpr (std::is_same_v<T, bool>) {
    sink(value ? "true" : "false");
  } else if constexpr (std::is_integral_v<T>) {
    write_number(sink, value);
  } else if constexpr (std::is_floating_point_v<T>) {
    write_float(sink, value);
  } else if constexpr (smachac::detail::is_text<T>::value) {
    write_text(sink, value);
  } else if constexpr (std::is_same_v<T, None>) {
    sink("null");
  } else if constexpr (smachac::detail::is_optional<T>::value) {
    value.has_value() ? write_json(sink, *value) : sink("null");
  } else if constexpr (smachac::detail::is_list<T>::value) {
    sink("[");
    for (std::size_t i = 0; i < value.size(); ++i) {
      sink(i == 0 ? "" : ", ");
      write_json(sink, value[i]);
    }
    sink("]");
  } else if constexpr (std::is_same_v<T, Point>) {
    list(value.x, value.y, value.z);
  } else if constexpr (std::is_same_v<T, Quaternion>) {
    list(value.x, value.y, value.z, value.w);
  } else if constexpr (std::is_same_v<T, Pose>) {
    list(value.position, value.orientation);
  } else if constexpr (std::is_same_v<T, Transform>) {
    list(value.translation, value.rotation);
  } else if constexpr (Fields<T>::value) {
    const char *before = "{\"";
    smachac::detail::each_field(value, [&](const char *name, const auto &member) {
      if constexpr (smachac::detail::is_optional<std::decay_t<decltype(member)>>::value) {
        if (!member.has_value()) {
          return;
        }
      }
      sink(before);
      write_escaped(sink, name);
      sink("\": ");
      write_json(sink, member);
      before = ", \"";
    });
    sink(before[0] == '{' ? "{}" : "}");
  } else if constexpr (Opaque<T>::value) {
    sink("null");
  } else {
    sink("{\"frame_id\": ");
    write_json(sink, value.frame_id);
    sink(", \"pose\": ");
    write_json(sink, value.pose);
    sink(", \"stamp\": ");
    write_json(sink, value.stamp);
    sink("}");
  }
}

} // namespace step
} // namespace v0_1_0
} // namespace smachac

#endif // SMACHAC_STEP_VALUES_HPP
