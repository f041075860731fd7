#include "io/study/report_words.h"

#include <fmt/format.h>

#include <cmath>

namespace skybake::io {

std::string Words::number(double value, int decimals) const {
    if (!std::isfinite(value)) return "–";
    std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
    const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
    if (language_ == Language::german) {
        if (const std::size_t point = text.find('.'); point != std::string::npos) text[point] = ',';
    }
    return value < 0.0 && !is_zero ? std::string("−").append(text) : text;
}

std::string Words::change(double value, int decimals) const {
    const std::string text = number(value, decimals);
    const bool is_positive = value > 0.0 && text.find_first_of("123456789") != std::string::npos;
    return is_positive ? std::string("+").append(text) : text;
}

std::string Words::count(std::uint64_t value) const {
    const std::string digits = std::to_string(value);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += "\u202f";  // narrow and without a break
        text += digits[i];
    }
    return text;
}

std::string Words::metric(Metric metric) const {
    const Words& w = *this;
    switch (metric) {
        case Metric::sun_hours:
            return w("hours of direct sun", "Stunden direkter Sonne");
        case Metric::longest_sun_hours:
            return w("longest unbroken sun", "längste Sonne ohne Unterbrechung");
        case Metric::shadow_hours:
            return w("hours of shadow", "Stunden im Schatten");
        case Metric::longest_shadow_hours:
            return w("longest unbroken shadow", "längster Schatten ohne Unterbrechung");
        case Metric::new_shadow_hours:
            return w("hours of new shadow", "Stunden neuen Schattens");
        case Metric::sky_view_factor:
            return w("sky view factor", "Himmelssichtfaktor");
        case Metric::sky_component_pct:
            return w("sky component (CIE overcast)", "Himmelslichtanteil (CIE bedeckt)");
        case Metric::sunshine_pct:
            return w("probable sunlight of the period", "wahrscheinliche Besonnung des Zeitraums");
        case Metric::winter_sunshine_pct:
            return w("probable sunlight in winter", "wahrscheinliche Besonnung im Winter");
        case Metric::beam_kwh_m2:
            return w("irradiation by the sun's beam", "Einstrahlung, direkt");
        case Metric::sky_kwh_m2:
            return w("irradiation by the sky", "Einstrahlung, diffus");
        case Metric::irradiation_kwh_m2:
            return w("irradiation, beam and sky", "Einstrahlung, direkt und diffus");
        case Metric::indirect_kwh_m2:
            return w("irradiation reflected by the city", "von der Stadt reflektierte Einstrahlung");
        case Metric::reflected_kwh_m2:
            return w("reflected by open ground", "vom freien Boden reflektiert");
        case Metric::light_incidence_deg:
            return w("angle of free light incidence", "Winkel freien Lichteinfalls");
        case Metric::sun_lx:
            return w("illuminance by the sun", "Beleuchtungsstärke, Sonne");
        case Metric::sky_lx:
            return w("illuminance by the sky", "Beleuchtungsstärke, Himmel");
        case Metric::indirect_lx:
            return w("illuminance by reflected light", "Beleuchtungsstärke, reflektiertes Licht");
        case Metric::illuminance_lx:
            return w("illuminance", "Beleuchtungsstärke");
    }
    return "";
}

std::string Words::unit(Metric metric) const {
    const std::string_view plain = traits_of(metric).unit;
    if (plain == "kWh/m2") return "kWh/m²";
    if (plain == "deg") return "°";
    return std::string(plain == "1" ? "" : plain);
}

std::string Words::kind(ReceiverKind kind) const {
    const Words& w = *this;
    switch (kind) {
        case ReceiverKind::ground:
            return w("ground", "Boden");
        case ReceiverKind::polygon:
            return w("areas", "Flächen");
        case ReceiverKind::roof:
            return w("roofs", "Dächer");
        case ReceiverKind::facade:
            return w("façades", "Fassaden");
        case ReceiverKind::window:
            return w("windows", "Fenster");
        case ReceiverKind::point:
            return w("points", "Punkte");
    }
    return "";
}

std::string Words::role(std::string_view role) const {
    constexpr std::pair<std::string_view, std::string_view> kGerman[] = {
        {"rule", "Regel"},        {"city", "Stadt"},    {"plan", "Vorhaben"}, {"before", "frühere Stadt"},
        {"polygons", "Polygone"}, {"points", "Punkte"}, {"weather", "Wetter"}};
    for (const auto& [english, german] : kGerman) {
        if (english == role) return (*this)(english, german);
    }
    return std::string(role);
}

std::string Words::verdict(Verdict verdict) const {
    const Words& w = *this;
    switch (verdict) {
        case Verdict::none:
            return "–";
        case Verdict::pass:
            return w("pass", "erfüllt");
        case Verdict::borderline:
            return w("borderline", "Grenzfall");
        case Verdict::fail:
            return w("fail", "nicht erfüllt");
    }
    return "";
}

std::string Words::day(CalendarDay day) const {
    constexpr const char* kEnglish[] = {"January", "February", "March",     "April",   "May",      "June",
                                        "July",    "August",   "September", "October", "November", "December"};
    constexpr const char* kGerman[] = {"Jänner", "Februar", "März",      "April",   "Mai",      "Juni",
                                       "Juli",   "August",  "September", "Oktober", "November", "Dezember"};
    return language_ == Language::english ? fmt::format("{} {}", day.day, kEnglish[day.month - 1])
                                          : fmt::format("{}. {}", day.day, kGerman[day.month - 1]);
}

std::string Words::column(const Study& study, const Column& column) const {
    std::string text = metric(column.metric);
    if (column.day) text += ", " + day(study.days[*column.day].day());
    if (column.instant) text += fmt::format(", {}", study.instants[*column.instant]);
    if (column.is_before) text += (*this)(", before", ", vorher");
    const std::string u = unit(column.metric);
    return u.empty() ? text : fmt::format("{} [{}]", text, u);
}

}  // namespace skybake::io
