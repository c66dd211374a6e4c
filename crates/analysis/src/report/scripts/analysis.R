# The numbers of this report once more, by R's base functions, and two mixed models.
#
#   Rscript analysis.R            computes, compares with data/numbers.csv, fits the models
#   Rscript analysis.R no-models  without the models
#   Rscript analysis.R one-model  with the first model alone
#
# In: data/trials.csv (the trials in the analysis, after all exclusions) and data/numbers.csv (what
# Mimique computed). Out: data/numbers-r.csv. Exit status 1 if a number differs by more than 1e-8 of
# its size or, where that is more, by more than its tolerance: maxima are found by a general optimiser, and p of random
# draws are compared with draws of R's own.

arguments <- commandArgs(trailingOnly = TRUE)
script <- sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE))
if (length(script) == 1) setwd(dirname(normalizePath(script)))
invisible(Sys.setlocale("LC_COLLATE", "C"))
set.seed(1)

trials <- read.csv("data/trials.csv", colClasses = "character", check.names = FALSE,
                   na.strings = "", encoding = "UTF-8")
person <- trials$participant_id

# A column as numbers; words become their places in order.
number <- function(name) {
  column <- trials[[name]]
  values <- suppressWarnings(as.numeric(column))
  if (all(is.na(values[!is.na(column)]))) values <- as.integer(factor(column))
  values
}

# Matched sets: trials of one person that are equal in some columns. One mean per set (rows) and level (columns), only of
# the sets that a person has at every level, and the set of each trial.
set_of <- function(matched) do.call(paste, c(list(person), lapply(matched, function(name) trials[[name]]), sep = "\r"))
set_means <- function(matched, y, g, levels, among = TRUE) {
  v <- number(y)
  keep <- !is.na(v) & trials[[g]] %in% levels & among
  m <- tapply(v[keep], list(set_of(matched)[keep], factor(trials[[g]][keep], levels)), mean)
  m[complete.cases(m), , drop = FALSE]
}
# Whether each trial is of such a set.
is_matched <- function(matched, y, g, levels, among = TRUE) {
  !is.na(number(y)) & trials[[g]] %in% levels & among & set_of(matched) %in% rownames(set_means(matched, y, g, levels, among))
}
# Mean of each person (rows) at each level (columns) over the matched sets, to ten decimals, so that equal means have equal
# ranks; only people who have one.
person_means <- function(matched, y, g, levels) {
  m <- set_means(matched, y, g, levels)
  round(rowsum(m, sub("\r.*", "", rownames(m))) / as.vector(table(sub("\r.*", "", rownames(m)))), 10)
}

# Mean of each person over all trials, and what the first of them says of the person.
overall_means <- function(y) {
  v <- number(y)
  tapply(v[!is.na(v)], person[!is.na(v)], mean)
}
about <- function(name, people) trials[[name]][match(people, person)]

# The tests, each of them of plain vectors.
@TESTS@

# What is taken from the trials for a test.
groups <- function(values, labels, levels) {
  keep <- !is.na(values) & labels %in% levels
  list(values = values[keep], groups = droplevels(factor(labels[keep], levels)))
}
by_unit <- function(y, g, levels, unit) {
  if (unit == "trials") return(groups(number(y), trials[[g]], levels))
  means <- overall_means(y)
  groups(as.vector(means), about(g, names(means)), levels)
}

of_groups <- function(test, y, g, levels, unit) test(by_unit(y, g, levels, unit))

# Each person's difference between two levels, compared between groups of people; Holm's correction is
# over all pairs of levels.
of_differences_by_trait <- function(test, matched, y, g, levels, a, b, trait, trait_levels) {
  m <- person_means(matched, y, g, levels)
  of_pair <- function(pair) {
    test(groups(round(m[, pair[1]] - m[, pair[2]], 9), about(trait, rownames(m)), trait_levels))
  }
  pairs <- combn(length(levels), 2)
  p <- p.adjust(apply(pairs, 2, function(pair) of_pair(pair)[["p"]]), "holm")
  c(of_pair(c(a, b)), p_holm = p[pairs[1, ] == a & pairs[2, ] == b])
}

of_columns <- function(test, x, y, unit) {
  if (unit == "trials") return(test(number(x), number(y)))
  means <- overall_means(y)
  test(number(x)[match(names(means), person)], as.vector(means))
}
of_correlations <- function(test, x, y, levels = NULL, matched = NULL) {
  keep <- if (is.null(levels)) TRUE else is_matched(matched, y, x, levels)
  data <- data.frame(x = number(x), y = number(y), person = person)
  data <- data[complete.cases(data) & keep, ]
  rho <- suppressWarnings(sapply(split(data, data$person), function(own) cor(own$x, own$y, method = "spearman")))
  result <- test(unname(rho[!is.na(rho)]))
  c(result[c("statistic", "p")], effect = unname(result["estimate"]), result["n"])
}

of_matched_trials <- function(test, y, g, levels, matched) {
  v <- number(y)
  keep <- !is.na(v) & trials[[g]] %in% levels
  key <- do.call(paste, c(list(person[keep]), lapply(matched, function(name) trials[[name]][keep]), sep = "\r"))
  m <- tapply(v[keep], list(key, factor(trials[[g]][keep], levels)), mean)
  m <- m[complete.cases(m), , drop = FALSE]
  test(m[, 1] - m[, 2])
}
of_people <- function(test, matched, y, g, levels, a, b) {
  m <- person_means(matched, y, g, levels)
  test(m[, a] - m[, b])
}
of_blocks <- function(test, matched, y, g, levels) test(person_means(matched, y, g, levels))

# Whether a difference lies between two bounds.
of_people_within <- function(test, matched, y, g, levels, low, high) {
  m <- person_means(matched, y, g, levels)
  test(m[, 1] - m[, 2], low, high)
}
of_groups_within <- function(test, y, g, levels, unit, low, high) {
  test(by_unit(y, g, levels, unit), low, high)
}

of_two_factors <- function(test, y, a, a_levels, b, b_levels, effect, unit) {
  v <- number(y)
  of_a <- trials[[a]]
  of_b <- trials[[b]]
  if (unit != "trials") {
    v <- overall_means(y)
    of_a <- about(a, names(v))
    of_b <- about(b, names(v))
  }
  keep <- !is.na(v) & of_a %in% a_levels & of_b %in% b_levels
  test(as.vector(v)[keep], of_a[keep], of_b[keep], effect)
}

# The means of each person and combination, over trials that are matched in both factors.
of_combinations <- function(test, y, a, a_levels, b, b_levels, effect, matched_a, matched_b) {
  v <- number(y)
  keep <- is_matched(matched_a, y, a, a_levels)
  keep <- is_matched(matched_b, y, b, b_levels, keep)
  keep <- is_matched(matched_a, y, a, a_levels, keep)
  cell <- paste(trials[[a]][keep], trials[[b]][keep], sep = "\r")
  m <- tapply(v[keep], list(person[keep], cell), mean)
  m <- m[complete.cases(m), , drop = FALSE]
  grid <- expand.grid(person = rownames(m), cell = colnames(m), stringsAsFactors = FALSE)
  parts <- strsplit(grid$cell, "\r", fixed = TRUE)
  test(as.vector(m), vapply(parts, `[`, "", 1), vapply(parts, `[`, "", 2), grid$person, effect)
}

of_level <- function(test, matched, y, g, level, levels) {
  test(number(y)[is_matched(matched, y, g, levels) & trials[[g]] %in% level])
}
of_person_means <- function(test, matched, y, g, levels, place) {
  c(mean = test(person_means(matched, y, g, levels)[, place]))
}

of_answers <- function(test, question, g, levels) {
  truth <- trials[[paste0(question, ".truth")]]
  answer <- trials[[paste0(question, ".answer")]]
  keep <- !is.na(truth) & !is.na(answer)
  if (g != "") keep <- keep & trials[[g]] %in% levels
  test(truth[keep], answer[keep])
}

# How well a category is told from all others, person by person; at some levels of a factor, or without one in all
# trials.
of_detection <- function(test, question, category, g, levels, matched = NULL, all_levels = NULL) {
  truth <- trials[[paste0(question, ".truth")]]
  answer <- trials[[paste0(question, ".answer")]]
  keep <- !is.na(truth) & !is.na(answer)
  if (g != "") keep <- keep & trials[[g]] %in% levels
  if (!is.null(matched)) keep <- keep & is_matched(matched, question, g, all_levels)
  test(person[keep], truth[keep], answer[keep], category)
}
# d' or criterion of each person (rows) at each level (columns); only people who have all of them.
detection_by <- function(matched, what, question, category, g, levels) {
  people <- sort(unique(person))
  m <- sapply(levels, function(level) {
    of_detection(sensitivity, question, category, g, level, matched, levels)[what, ][people]
  })
  m[complete.cases(m), , drop = FALSE]
}
of_detection_blocks <- function(test, matched, what, question, category, g, levels) {
  test(detection_by(matched, what, question, category, g, levels))
}
of_detection_people <- function(test, matched, what, question, category, g, levels, a, b) {
  m <- detection_by(matched, what, question, category, g, levels)
  test(m[, a] - m[, b])
}

# Mean ratings of the clips that everybody rated, and first answers with gaps: a row per clip, a column per person.
of_clips_by_people <- function(test, y) {
  v <- number(y)
  keep <- !is.na(v)
  m <- tapply(v[keep], list(trials$stimulus[keep], person[keep]), mean)
  test(m[complete.cases(m), , drop = FALSE])
}
of_first_answers <- function(test, y, level) {
  v <- number(y)
  keep <- !is.na(v)
  test(tapply(v[keep], list(trials$stimulus[keep], person[keep]), function(own) own[1]), level)
}
# Items of a scale, a row per person; to turn an item round changes no more than its sign does.
of_items <- function(test, items, reversed) {
  m <- sapply(items, function(item) overall_means(item)[unique(person)])
  m <- m[complete.cases(m), , drop = FALSE]
  m[, items %in% reversed] <- -m[, items %in% reversed]
  test(m)
}

# Choices between levels of a factor: who chose, the level on either side, the answer.
choices_of <- function(question, g, levels) {
  answer <- trials[[paste0(question, ".answer")]]
  own <- trials[[g]]
  other <- trials[[paste0("beside.", g)]]
  keep <- !is.na(answer) & own %in% levels & other %in% levels
  keep[keep] <- own[keep] != other[keep]
  other_left <- trials$beside_side[keep] == "left"
  list(person = person[keep], answer = answer[keep],
       left = ifelse(other_left, other[keep], own[keep]),
       right = ifelse(other_left, own[keep], other[keep]))
}
of_choices <- function(test, question, g, levels, side) {
  d <- choices_of(question, g, levels)
  test(d$person, d$left, d$right, d$answer, side == 1)
}
# Choices of the first of two levels less those of the second, of each trial or of each person.
of_net_choices <- function(test, question, g, levels, unit) {
  d <- choices_of(question, g, levels)
  net <- (d$answer == "left") - (d$answer == "right")
  net <- ifelse(d$left == levels[1], net, -net)
  if (unit != "trials") net <- as.vector(tapply(net, d$person, sum))
  test(net)
}
# How often each person (rows) chose each level (columns); a tie is half a choice.
of_wins <- function(test, question, g, levels) {
  d <- choices_of(question, g, levels)
  won <- function(side, word) {
    share <- (d$answer == word) + (d$answer == "same") / 2
    tapply(share, list(d$person, factor(side, levels)), sum, default = 0)
  }
  test(won(d$left, "left") + won(d$right, "right"))
}

# Which of every two levels was rated higher on the same page.
of_page_order <- function(test, y, g, levels) {
  v <- number(y)
  keep <- !is.na(v) & trials[[g]] %in% levels
  d <- data.frame(v = v[keep], level = match(trials[[g]][keep], levels), person = person[keep],
                  page = paste(person[keep], trials$trial_order[keep]))
  d <- d[order(d$page, d$level), ]
  pairs <- do.call(rbind, lapply(split(d, d$page), function(own) {
    if (nrow(own) < 2) return(NULL)
    two <- utils::combn(nrow(own), 2)
    data.frame(person = own$person[1], left = levels[own$level[two[1, ]]], right = levels[own$level[two[2, ]]],
               sign = sign(own$v[two[1, ]] - own$v[two[2, ]]))
  }))
  test(pairs$person, pairs$left, pairs$right, c("right", "same", "left")[pairs$sign + 2], FALSE)
}
# Ratings by the levels of a factor, over people and segments.
of_people_and_segments <- function(test, matched, y, g, levels) {
  v <- number(y)
  keep <- is_matched(matched, y, g, levels) & !is.na(trials$segment)
  test(v[keep], trials[[g]][keep], person[keep], trials$segment[keep])
}
# Ratings of confidence, blocks that choose what is shown, and ratings that follow the clip.
@BLOCKS@

# p of a mixed model as Mimique has found it: R comes near it, not to the last digit (the models below).
given <- function(test, p) c(p = p)

keys <- character()
names_of <- character()
found <- numeric()
check <- function(key, values) {
  keys <<- c(keys, rep(key, length(values)))
  names_of <<- c(names_of, names(values))
  found <<- c(found, unname(values))
}
# Holm's correction of the p of several checks together. Where a hypothesis has two p of which at most one can be wrong
# (equivalence and difference), a p counts for the hypotheses that are not settled by smaller p.
holm <- function(of, into, hypothesis = seq_along(of)) {
  # A check that is itself the smallest of several counts with its corrected p.
  own <- function(name) found[match(paste(of, name), paste(keys, names_of))]
  p <- ifelse(is.na(own("p_holm")), own("p"), own("p_holm"))
  places <- order(p)
  open <- vapply(seq_along(p), function(i) length(unique(hypothesis[places[i:length(p)]])), 1)
  p[places] <- pmin(1, cummax(open * p[places]))
  for (i in seq_along(of)) check(into[i], c(p_holm = p[i]))
}

@CALLS@

result <- data.frame(key = keys, name = names_of, value = format(found, digits = 17, trim = TRUE))
write.csv(result, "data/numbers-r.csv", row.names = FALSE, quote = TRUE)
expected <- read.csv("data/numbers.csv", colClasses = c("character", "character", "numeric", "numeric"),
                     encoding = "UTF-8")
place <- match(paste(expected$key, expected$name, sep = "\r"), paste(keys, names_of, sep = "\r"))
own <- found[place]
size <- pmax(abs(expected$value), abs(own))
allowed <- pmax(1e-8 * size + 1e-12 * (size > 1e-10), expected$tolerance)
far <- is.na(place) | is.na(own) | abs(own - expected$value) > allowed
cat(sprintf("%d numbers computed, %d compared, %d differ\n", length(found), nrow(expected), sum(far)))
if (any(far)) {
  print(data.frame(expected[far, ], r = own[far]), row.names = FALSE)
  quit(status = 1)
}

# Mixed models keep every trial and let people and clips differ: the way to interactions on ratings of
# few steps. Their numbers stand in no table of the report.
fitted_models <- 0
fit <- function(title, package, model) {
  cat("\n", title, "\n", sep = "")
  wanted <- if ("no-models" %in% arguments) 0 else if ("one-model" %in% arguments) 1 else Inf
  if (fitted_models >= wanted) return(cat("left out\n"))
  fitted_models <<- fitted_models + 1
  if (!requireNamespace(package, quietly = TRUE)) {
    return(cat(sprintf("not fitted: install.packages(\"%s\")\n", package)))
  }
  tryCatch(print(summary(model())), error = function(e) cat("not fitted:", conditionMessage(e), "\n"))
  invisible()
}
@MODELS@
