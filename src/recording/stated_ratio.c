/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of how many samples of the converter a row was made: decimation, "every 4th sample is stored", averages. */
#include "base/decimal.h"
#include "recording/letters.h"
#include "recording/recorded_unit.h"
#include "recording/stated_private.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TOKENS 32
#define WORD 32
#define MOST 4096 /* samples of a row; more are numbers of something else */

/* Whatever stands beside them, a number is one of samples for a row. */
#define THINS                                                                                               \
  "decimat decimac decimaz dezimi downsampl subsampl undersampl unterabtast sousechantill submuestr diezm " \
  "sottocampion thinn thinby ausdunn ausduenn datenreduk datareduc samplereduc ratereduc datenverdicht "    \
  "reductionfactor reduktionsfaktor facteurdereduction compressionfactor compressionratio "                 \
  "kompressionsfaktor kompressionsrate facteurdecompression"

/* Of a file's bytes as a rule, and of its rows only with a ratio. */
#define COMPRESSES "compress kompress komprim comprim compresi"

/* Beside words of the lists below alone: "mean temperature 40" is none of samples. */
#define AVERAGES "averaging averages averaged mittelung mittelungen gemittelt moyennage moyennes promediado binning"
#define MEANS "average avg mean mittelwert mittel moyenne promedio media boxcar"
#define OVERSAMPLES "oversampl uberabtast ueberabtast surechantill sobremuestr sovracampion"
#define DIVIDES                                                                                                   \
  "divider divisor teiler vorteiler speicherteiler abtastteiler samplingdivider sampledivider decim stride step " \
  "diviseur downsample prescaler"
#define SAMPLES                                                                                             \
  "samples sample scans scan values value points point readings reading measurements rows row wert werte "  \
  "werten abtastwert abtastwerte abtastwerten messwert messwerte messwerten abtastung abtastungen punkte "  \
  "punkt punkten zeile zeilen echantillon echantillons mesure mesures valeur valeurs ligne lignes muestra " \
  "muestras valor valores punto puntos campione campioni valore valori punti"
#define COUNTS "factor faktor facteur fattore count number num anzahl nombre numero block n ratio fold fach x times"
#define FILLERS                                                                                               \
  "of over uber ueber per pro je par por each jede jeder every is are was were the a an by with mit aus von " \
  "de des di du su sur to auf und and rate sampling abtastung abtastrate software signal data daten digital"
#define KEPT                                                                                                  \
  "stored kept keep logged recorded retained saved written store storage stores keeps log logs logging save " \
  "record gespeichert speichern aufgezeichnet behalten abgelegt geschrieben enregistre enregistree "          \
  "enregistres conserve garde guardado guardada registrato salvato"
#define FREQUENCIES "hz khz mhz s/s ks/s sps ksps"

struct token {
  char word[WORD]; /* plain; "": a number or a mark */
  char mark;
  double number; /* NaN: none */
};

/* What stands between two commas or brackets. */
struct clause {
  struct token token[TOKENS];
  int count;
  char folded[EO_STATED_KEY];
};

static bool ends_clause(const char *p, const char *start)
{
  bool decimal = *p == ',' && p > start && isdigit((unsigned char)p[-1]) && isdigit((unsigned char)p[1]);
  return strchr(",;|\t()[]\"", *p) && !decimal;
}

/* "every_nth" and "storeEvery" are two words, "down-sampled" and "kS/s" one. */
static const char *take_word(const char *p, struct token *token)
{
  char word[WORD];
  size_t n = 0;
  const char *start = p;
  for (; isalpha((unsigned char)*p) || (unsigned char)*p >= 0x80 ||
         (strchr("-/", *p) && *p && isalpha((unsigned char)p[1]));
       p++) {
    if (p - start > 3 && islower((unsigned char)p[-1]) && isupper((unsigned char)*p))
      break;
    if (*p != '-' && n + 1 < sizeof word)
      word[n++] = *p;
  }
  eo_letters_plain(word, n, token->word, sizeof token->word);
  return p;
}

static const char *take_clause(const char *p, struct clause *clause)
{
  const char *start = p;
  char text[EO_STATED_KEY];
  clause->count = 0;
  while (*p && !ends_clause(p, start) && clause->count < TOKENS) {
    struct token *token = &clause->token[clause->count];
    *token = (struct token){.number = NAN};
    const char *after = isdigit((unsigned char)*p) ? eo_decimal_read(p, '.', &token->number) : NULL;
    if (after && *after == ',' && isdigit((unsigned char)after[1]))
      after = eo_decimal_read(p, ',', &token->number);
    if (after)
      p = after;
    else if (isalpha((unsigned char)*p) || (unsigned char)*p >= 0x80)
      p = take_word(p, token);
    else
      token->mark = strchr("/:", *p) ? *p : '\0', p++;
    clause->count += *token->word || token->mark || !isnan(token->number);
  }
  snprintf(text, sizeof text, "%.*s", (int)(p - start < EO_STATED_KEY ? p - start : EO_STATED_KEY - 1), start);
  eo_stated_fold(text, clause->folded);
  return p;
}

static const struct token *token_at(const struct clause *clause, int i)
{
  static const struct token none = {.number = NAN};
  return i >= 0 && i < clause->count ? &clause->token[i] : &none;
}

static bool is_word(const struct clause *clause, int i, const char *words)
{
  const char *word = token_at(clause, i)->word;
  return *word && eo_stated_is_one(word, words);
}

static bool any_word(const struct clause *clause, const char *words)
{
  for (int i = 0; i < clause->count; i++)
    if (is_word(clause, i, words))
      return true;
  return false;
}

/* The number itself, or the word for it behind "every" and "one in"; 0: none that can be one of samples. A unit behind
   it makes it something else, and so does an order of a filter. */
static double samples_at(const struct clause *clause, int i)
{
  static const char orders[] = "order ordnung ordre taps tap stage stages pole poles bit bits";
  static const char *const words[] = {"other second zweite zweiter zweiten zwei two deux deuxieme", "third dritte drei",
                                      "fourth four vierte vierter vier quatre quatrieme",
                                      "fifth five funfte fuenfte cinq cinquieme"};
  const struct token *token = token_at(clause, i);
  double factor;
  for (int k = 0; k < 4 && *token->word; k++)
    if (eo_stated_is_one(token->word, words[k]))
      return k + 2;
  const char *unit = token_at(clause, i + 1)->word;
  enum eo_quantity quantity = *unit ? eo_unit_find(unit, &factor) : EO_QUANTITY_NONE;
  bool own = quantity != EO_QUANTITY_NONE && quantity != EO_QUANTITY_COUNT && strlen(unit) > 1;
  own = own || quantity == EO_QUANTITY_TIME || quantity == EO_QUANTITY_ANGLE;
  if (isnan(token->number) || own || is_word(clause, i + 1, orders) || is_word(clause, i + 2, orders) ||
      is_word(clause, i - 1, orders) || is_word(clause, i - 2, orders))
    return 0;
  return token->number > 1 && token->number <= MOST && token->number == floor(token->number) ? token->number : 0;
}

/* "1:4", "4:1", "1/4", 0.25 and 4 at their first number. */
static double ratio_at(const struct clause *clause, int i)
{
  const struct token *token = token_at(clause, i);
  bool pair = token_at(clause, i + 1)->mark && !isnan(token_at(clause, i + 2)->number);
  if (isnan(token->number))
    return 0;
  if (token->number == 1 && pair)
    return samples_at(clause, i + 2);
  double whole = round(1 / token->number);
  if (token->number < 1 && token->number > 1. / MOST && fabs(whole * token->number - 1) < 1e-3)
    return whole;
  return samples_at(clause, i);
}

/* "every 4th sample", "jeder vierte Wert", "every_nth=4", "store every: 4". */
static double every(const struct clause *clause)
{
  for (int i = 0; i < clause->count; i++) {
    if (!is_word(clause, i, "every each jede jeder jeden jedes chaque cada ogni toutesles tousles les"))
      continue;
    int at = i + 1;
    bool nth = is_word(clause, at, "n nth nte nten nieme");
    at += nth;
    at += token_at(clause, at)->mark != '\0';
    double samples = samples_at(clause, at++);
    at += is_word(clause, at, "th st nd rd e eme ieme te ten ter");
    if (samples > 1 && (nth || is_word(clause, at, SAMPLES) || any_word(clause, KEPT)))
      return samples;
  }
  return 0;
}

/* "1 of 4 samples", "one in four is stored", "un point sur 4 est enregistre"; "run 1 of 4" counts something else. */
static double one_of(const struct clause *clause)
{
  for (int i = 0; i < clause->count; i++) {
    if (token_at(clause, i)->number != 1 && !is_word(clause, i, "one un une ein einer eine uno una"))
      continue;
    int at = i + 1;
    at += is_word(clause, at, SAMPLES);
    at += is_word(clause, at, "out");
    double samples = is_word(clause, at, "of in von aus sur de di su") || token_at(clause, at)->mark
                         ? samples_at(clause, at + 1)
                         : 0;
    if (samples > 1 && (is_word(clause, at + 2, SAMPLES) || any_word(clause, KEPT)))
      return samples;
  }
  return 0;
}

/* "64 kHz / 16", "64000/16 Hz", "stored rate = rate / 4"; in "4 kHz / 2 channels" the number is of something else. */
static double quotient(const struct clause *clause)
{
  for (int i = 1; i + 1 < clause->count; i++) {
    double samples = samples_at(clause, i + 1), below = token_at(clause, i + 1)->number;
    if (!token_at(clause, i)->mark)
      continue;
    if (samples > 1 && i + 2 == clause->count && is_word(clause, i - 1, FREQUENCIES))
      return samples;
    if (samples > 1 && i + 2 == clause->count && is_word(clause, i - 1, "rate fs samplerate abtastrate") &&
        any_word(clause, KEPT))
      return samples;
    if (is_word(clause, i + 2, FREQUENCIES) && below > 1 && below <= 64 && token_at(clause, i - 1)->number >= 1000)
      return below;
  }
  return 0;
}

/* "1:4" in brackets behind a rate. */
static double bracketed(const struct clause *clause, const struct clause *before)
{
  bool rate = is_word(before, before->count - 1, FREQUENCIES);
  return rate && clause->count == 3 && token_at(clause, 0)->number == 1 && token_at(clause, 1)->mark
             ? samples_at(clause, 2)
             : 0;
}

/* "resampled by 1/4"; what is made more is none of samples. */
static double resampled(const struct clause *clause)
{
  for (int i = 0; i < clause->count && eo_stated_holds(clause->folded, "resampl"); i++)
    if (token_at(clause, i)->number <= 1 && ratio_at(clause, i) > 1)
      return ratio_at(clause, i);
  return 0;
}

/* The number that goes with a word that means nothing else: the first behind the words, else the last before them. */
static double thinned(const struct clause *clause)
{
  double before = 0;
  bool behind = false;
  for (int i = 0; i < clause->count; i++) {
    double samples = ratio_at(clause, i);
    behind = behind ||
             eo_stated_holds(token_at(clause, i)->word, "dezim decim downsam subsam unders unterabt sousech submue "
                                                        "sottoc diezm reduk reduc verdicht thin dunn duenn");
    if (samples > 1 && behind)
      return samples;
    before = samples > 1 ? samples : before;
  }
  return before;
}

/* A mean of samples, or a divider, in a clause that speaks of nothing else; *kept: rows were left out. */
static double divided(const struct clause *clause, bool *kept)
{
  double found = 0;
  bool mean = false, sure = false;
  for (int i = 0; i < clause->count; i++) {
    const struct token *token = &clause->token[i];
    bool over = *token->word && eo_stated_holds(token->word, OVERSAMPLES), divides = is_word(clause, i, DIVIDES),
         averages = is_word(clause, i, AVERAGES);
    found = found > 1 ? found : ratio_at(clause, i);
    *kept = *kept || divides;
    mean = mean || is_word(clause, i, MEANS);
    sure = sure || over || divides || averages || is_word(clause, i, SAMPLES " " COUNTS);
    if (*token->word && !over && !divides && !averages &&
        !is_word(clause, i, MEANS " " SAMPLES " " COUNTS " " FILLERS " " KEPT " " FREQUENCIES))
      return 0;
  }
  bool named = mean || *kept || any_word(clause, AVERAGES) || eo_stated_holds(clause->folded, OVERSAMPLES);
  return named && sure ? found : 0;
}

/* "Compression 4:1". */
static double compressed(const struct clause *clause)
{
  for (int i = 0; i + 2 < clause->count && eo_stated_holds(clause->folded, COMPRESSES); i++)
    if (token_at(clause, i + 1)->mark && token_at(clause, i + 2)->number == 1 && samples_at(clause, i) > 1)
      return samples_at(clause, i);
    else if (token_at(clause, i)->number == 1 && ratio_at(clause, i) > 1)
      return ratio_at(clause, i);
  return 0;
}

/* "skip: 3", "skipped samples: 3": so many are left out before the next one, with "factor" so many less one; rows and
 * lines are those of a heading. */
static double skipped(const struct clause *clause)
{
  double number = NAN;
  bool skips = false, each = any_word(clause, "every factor faktor");
  for (int i = 0; i < clause->count; i++) {
    const struct token *token = &clause->token[i];
    bool skip = is_word(clause, i, "skip skips skipped skipping skipfactor skipcount nskip sampleskip");
    number = isnan(number) ? token->number : number;
    skips = skips || skip;
    if (*token->word && !skip &&
        !is_word(clause, i, COUNTS " sample samples scan scans value values point points reading readings every of"))
      return 0;
  }
  return skips && number >= 1 && number < MOST && number == floor(number) ? number + !each : 0;
}

/* What a clause says of rows that were left out; 0: nothing. */
static double left_out(const struct clause *clause, const struct clause *before)
{
  bool filter = eo_stated_holds(clause->folded, "filter cutoff nyquist bandw");
  double samples[] = {
      every(clause),      one_of(clause), filter ? 0 : quotient(clause), bracketed(clause, before), resampled(clause),
      compressed(clause), skipped(clause)};
  for (size_t i = 0; i < sizeof samples / sizeof *samples; i++)
    if (samples[i] > 1)
      return samples[i];
  return eo_stated_holds(clause->folded, THINS) ? thinned(clause) : 0;
}

double eo_stated_ratio(const char *line, enum eo_stated_strength *strength)
{
  struct clause clause = {0}, before;
  char folded[EO_STATED_KEY];
  eo_stated_fold(line, folded);
  bool inside = eo_stated_holds(folded, "intern sigmadelta deltasigma cycle zyklus"); /* of a converter or a bus */
  for (const char *p = line; *p;) {
    before = clause;
    p = take_clause(p, &clause);
    p += *p && ends_clause(p, p);
    bool kept = false;
    double samples = left_out(&clause, &before);
    *strength = EO_STATED_ROWS;
    if (samples > 1)
      return samples;
    samples = inside ? 0 : divided(&clause, &kept);
    *strength = kept ? EO_STATED_ROWS : EO_STATED_OUTPUT;
    if (samples > 1)
      return samples;
  }
  return 0;
}

struct eo_stated eo_stated_read_ratio(const char *key, const char *text)
{
  char line[256];
  struct eo_stated stated = eo_stated_nothing();
  snprintf(line, sizeof line, "%.60s: %.180s", key, text);
  stated.value = eo_stated_ratio(line, &stated.strength);
  stated.kind = stated.value > 1 ? EO_STATED_THINNED : EO_STATED_NOTHING;
  return stated;
}
