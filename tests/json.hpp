#pragma once

#include <cctype>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// Just enough JSON to check what the command prints. Throws std::runtime_error for anything else.
struct Json {
    enum class Kind { null, boolean, number, text, list, object };
    Kind kind = Kind::null;
    bool boolean = false;
    double number = 0.0;
    std::string text;
    std::vector<Json> list;
    std::map<std::string, Json> object;

    static Json parse(std::string_view source);

    const Json& operator[](const std::string& key) const {
        const auto at = object.find(key);
        if (at == object.end()) throw std::runtime_error("no key " + key);
        return at->second;
    }
    const Json& operator[](std::size_t i) const { return list.at(i); }
};

class JsonReader {
  public:
    explicit JsonReader(std::string_view source) : m_left(source) {}

    Json whole() {
        Json result = value();
        skip_space();
        if (!m_left.empty()) fail("text after the value");
        return result;
    }

  private:
    [[noreturn]] void fail(const std::string& why) const {
        throw std::runtime_error(why + " before: " + std::string(m_left.substr(0, 40)));
    }
    void skip_space() {
        while (!m_left.empty() && std::isspace(static_cast<unsigned char>(m_left.front())) != 0)
            m_left.remove_prefix(1);
    }
    bool take(std::string_view word) {
        skip_space();
        if (!m_left.starts_with(word)) return false;
        m_left.remove_prefix(word.size());
        return true;
    }
    void need(std::string_view word) {
        if (!take(word)) fail("expected " + std::string(word));
    }

    Json value() {
        Json result;
        if (take("null")) return result;
        if (take("true") || take("false")) {
            result.kind = Json::Kind::boolean;
            result.boolean = *(m_left.data() - 2) == 'u';
        } else if (take("{")) {
            read_object(result);
        } else if (take("[")) {
            read_list(result);
        } else if (m_left.starts_with('"')) {
            result.kind = Json::Kind::text;
            result.text = text();
        } else {
            read_number(result);
        }
        return result;
    }

    std::string text() {
        need("\"");
        std::string result;
        while (!m_left.empty() && m_left.front() != '"') {
            if (m_left.front() == '\\') m_left.remove_prefix(1);
            if (m_left.empty()) break;
            result += m_left.front();
            m_left.remove_prefix(1);
        }
        need("\"");
        return result;
    }

    void read_number(Json& result) {
        const std::string digits(m_left.substr(0, m_left.find_first_not_of("0123456789+-.eE")));
        char* end = nullptr;
        result.kind = Json::Kind::number;
        result.number = std::strtod(digits.c_str(), &end);
        if (digits.empty() || end != digits.c_str() + digits.size()) fail("no value");
        m_left.remove_prefix(digits.size());
    }

    void read_list(Json& result) {
        result.kind = Json::Kind::list;
        if (take("]")) return;
        do result.list.push_back(value());
        while (take(","));
        need("]");
    }

    void read_object(Json& result) {
        result.kind = Json::Kind::object;
        if (take("}")) return;
        do {
            skip_space();
            std::string key = text();
            need(":");
            if (!result.object.emplace(std::move(key), value()).second) fail("a key twice");
        } while (take(","));
        need("}");
    }

    std::string_view m_left;
};

inline Json Json::parse(std::string_view source) {
    return JsonReader(source).whole();
}

}  // namespace burnish
