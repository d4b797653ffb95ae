#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace liebench {

// A JSON schema (draft 7) as an independent implementation, valijson, understands it.
class JsonSchema {
 public:
  // Throws std::runtime_error where the text is not a schema.
  explicit JsonSchema(std::string_view text) {
    const auto json = nlohmann::json::parse(text);
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(json), schema_);
  }

  // What is wrong with a JSON text, one line a violation with its place; empty where it is valid.
  std::string violations(std::string_view json) const {
    const auto document = nlohmann::json::parse(json);
    valijson::Validator validator;
    valijson::ValidationResults results;
    std::string text;
    if (validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(document), &results)) return text;
    for (valijson::ValidationResults::Error error; results.popError(error);) {
      for (const std::string& place : error.context) text += place;
      text += ": " + error.description + '\n';
    }
    return text.empty() ? "invalid" : text;
  }

 private:
  valijson::Schema schema_;
};

}  // namespace liebench
