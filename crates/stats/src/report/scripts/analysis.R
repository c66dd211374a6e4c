# The numbers of this report once more, by R's base functions, and two mixed models.
#
#   Rscript analysis.R            computes, compares with data/numbers.csv, fits the models
#   Rscript analysis.R no-models  without the models
#   Rscript analysis.R one-model  with the first model alone
#
# In: data/trials.csv (the trials in the analysis, after all exclusions) and data/numbers.csv (what
# Mimique computed). Out: data/numbers-r.csv. Exit status 1 if a number differs by more than 1e-8 of
# its size.

arguments <- commandArgs(trailingOnly = TRUE)
script <- sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE))
if (length(script) == 1) setwd(dirname(normalizePath(script)))
invisible(Sys.setlocale("LC_COLLATE", "C"))

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

# Mean of each person (rows) at each level (columns); only people who have all of them.
person_means <- function(y, g, levels) {
  v <- number(y)
  keep <- !is.na(v) & trials[[g]] %in% levels
  m <- tapply(v[keep], list(person[keep], factor(trials[[g]][keep], levels)), mean)
  m[complete.cases(m), , drop = FALSE]
}

# Mean of each person over all trials, and what the first of them says of the person.
overall_means <- function(y) {
  v <- number(y)
  tapply(v[!is.na(v)], person[!is.na(v)], mean)
}
about <- function(name, people) trials[[name]][match(people, person)]

# Wilcoxon's signed ranks with Pratt's zeros: exact and conditional on the ranks up to 200 differences
# other than zero, normal beyond.
signed_ranks <- function(d) {
  d <- round(d, 9)
  r <- rank(abs(d))
  tossed <- r[d != 0]
  plus <- sum(r[d > 0])
  if (length(tossed) <= 200) {
    distribution <- 1
    for (k in round(2 * tossed)) distribution <- (c(distribution, numeric(k)) + c(numeric(k), distribution)) / 2
    w <- round(2 * plus)
    p <- min(1, 2 * min(sum(distribution[1:(w + 1)]), sum(distribution[(w + 1):length(distribution)])))
  } else {
    p <- 2 * pnorm(-abs(plus - sum(tossed) / 2) / sqrt(sum(tossed^2) / 4))
  }
  c(statistic = plus, p = p, effect = rank_biserial(d), n = length(d), hodges_lehmann(d))
}
rank_biserial <- function(d) {
  d <- d[d != 0]
  r <- rank(abs(d))
  (sum(r[d > 0]) - sum(r[d < 0])) / sum(r)
}

# Median and 95 % interval of the Walsh averages.
hodges_lehmann <- function(d) {
  walsh <- outer(d, d, "+") / 2
  walsh <- sort(walsh[lower.tri(walsh, diag = TRUE)])
  n <- length(d)
  cut <- if (n <= 200) {
    max(qsignrank(0.025, n) - 1, 0)
  } else {
    max(floor(length(walsh) / 2 - qnorm(0.975) * sqrt(n * (n + 1) * (2 * n + 1) / 24) - 0.5), 0)
  }
  cut <- min(cut, (length(walsh) - 1) %/% 2)
  c(estimate = median(walsh), low = walsh[cut + 1], high = walsh[length(walsh) - cut])
}

groups <- function(values, labels, levels) {
  keep <- !is.na(values) & labels %in% levels
  list(values = values[keep], groups = droplevels(factor(labels[keep], levels)))
}
compare_groups <- function(data) {
  if (nlevels(data$groups) == 2) two_groups(data) else many_groups(data)
}
many_groups <- function(data) {
  test <- kruskal.test(data$values, data$groups)
  h <- unname(test$statistic)
  n <- length(data$values)
  c(statistic = h, p = test$p.value, effect = h / (n - 1), n = n)
}
two_groups <- function(data) {
  x <- data$values[data$groups == levels(data$groups)[1]]
  y <- data$values[data$groups == levels(data$groups)[2]]
  test <- suppressWarnings(wilcox.test(x, y))
  u <- unname(test$statistic)
  c(statistic = u, p = test$p.value, effect = 2 * u / (length(x) * length(y)) - 1,
    n = length(x) + length(y))
}
by_unit <- function(y, g, levels, unit) {
  if (unit == "trials") return(groups(number(y), trials[[g]], levels))
  means <- overall_means(y)
  groups(as.vector(means), about(g, names(means)), levels)
}

kruskal_wallis <- function(y, g, levels, unit) many_groups(by_unit(y, g, levels, unit))
mann_whitney <- function(y, g, levels, unit) two_groups(by_unit(y, g, levels, unit))

differences_by_trait <- function(y, g, levels, a, b, trait, trait_levels) {
  m <- person_means(y, g, levels)
  of_pair <- function(pair) {
    compare_groups(groups(round(m[, pair[1]] - m[, pair[2]], 9), about(trait, rownames(m)), trait_levels))
  }
  pairs <- combn(length(levels), 2)
  p <- p.adjust(apply(pairs, 2, function(pair) of_pair(pair)[["p"]]), "holm")
  c(of_pair(c(a, b)), p_holm = p[pairs[1, ] == a & pairs[2, ] == b])
}

chi_square <- function(y, g, levels) {
  data <- groups(number(y), trials[[g]], levels)
  counts <- table(data$groups, data$values)
  test <- suppressWarnings(chisq.test(counts))
  plain <- suppressWarnings(chisq.test(counts, correct = FALSE))$statistic
  n <- sum(counts)
  c(statistic = unname(test$statistic), p = test$p.value,
    effect = sqrt(unname(plain) / (n * (min(dim(counts)) - 1))), n = n)
}

rho_of <- function(x, y) {
  keep <- !is.na(x) & !is.na(y)
  test <- suppressWarnings(cor.test(x[keep], y[keep], method = "spearman"))
  c(statistic = unname(test$estimate), p = test$p.value, effect = unname(test$estimate), n = sum(keep))
}
spearman <- function(x, y, unit) {
  if (unit == "trials") return(rho_of(number(x), number(y)))
  means <- overall_means(y)
  rho_of(number(x)[match(names(means), person)], as.vector(means))
}
wilcoxon_rho <- function(x, y) {
  data <- data.frame(x = number(x), y = number(y), person = person)
  data <- data[complete.cases(data), ]
  rho <- suppressWarnings(sapply(split(data, data$person), function(own) cor(own$x, own$y, method = "spearman")))
  result <- signed_ranks(unname(rho[!is.na(rho)]))
  c(result[c("statistic", "p")], effect = unname(result["estimate"]), result["n"])
}

wilcoxon_trials <- function(y, g, levels, matched) {
  v <- number(y)
  keep <- !is.na(v) & trials[[g]] %in% levels
  key <- do.call(paste, c(list(person[keep]), lapply(matched, function(name) trials[[name]][keep]), sep = "\r"))
  m <- tapply(v[keep], list(key, factor(trials[[g]][keep], levels)), mean)
  m <- m[complete.cases(m), , drop = FALSE]
  d <- round(m[, 1] - m[, 2], 9)
  used <- d[d != 0]
  exact <- length(used) < 50 && length(used) == length(d) && !anyDuplicated(abs(used))
  test <- suppressWarnings(wilcox.test(used, exact = exact, correct = TRUE))
  c(statistic = unname(test$statistic), p = test$p.value, effect = rank_biserial(d), n = length(d))
}
wilcoxon_people <- function(y, g, levels, a, b) {
  m <- person_means(y, g, levels)
  signed_ranks(m[, a] - m[, b])
}

friedman <- function(y, g, levels) {
  m <- person_means(y, g, levels)
  n <- nrow(m)
  k <- ncol(m)
  chi_square <- unname(friedman.test(m)$statistic)
  f <- (n - 1) * chi_square / (n * (k - 1) - chi_square)
  c(statistic = f, p = pf(f, k - 1, (k - 1) * (n - 1), lower.tail = FALSE),
    effect = chi_square / (n * (k - 1)), n = n)
}

# Scheirer, Ray and Hare: an analysis of variance of ranks (type I), read as chi-square.
scheirer_ray_hare <- function(y, a, a_levels, b, b_levels, effect, unit) {
  v <- number(y)
  of_a <- trials[[a]]
  of_b <- trials[[b]]
  if (unit != "trials") {
    v <- overall_means(y)
    of_a <- about(a, names(v))
    of_b <- about(b, names(v))
  }
  keep <- !is.na(v) & of_a %in% a_levels & of_b %in% b_levels
  r <- rank(as.vector(v)[keep])
  table <- anova(lm(r ~ factor(of_a[keep]) * factor(of_b[keep])))
  h <- table[["Sum Sq"]][effect] / var(r)
  c(statistic = h, p = pchisq(h, table[["Df"]][effect], lower.tail = FALSE),
    effect = h / (length(r) - 1), n = length(r))
}

# Wobbrock's aligned rank transform of the means of each person and combination.
aligned_rank_transform <- function(y, a, a_levels, b, b_levels, effect) {
  v <- number(y)
  keep <- !is.na(v) & trials[[a]] %in% a_levels & trials[[b]] %in% b_levels
  cell <- paste(trials[[a]][keep], trials[[b]][keep], sep = "\r")
  m <- tapply(v[keep], list(person[keep], cell), mean)
  m <- m[complete.cases(m), , drop = FALSE]
  grid <- expand.grid(person = rownames(m), cell = colnames(m), stringsAsFactors = FALSE)
  grid$y <- as.vector(m)
  parts <- strsplit(grid$cell, "\r", fixed = TRUE)
  grid$a <- factor(vapply(parts, `[`, "", 1))
  grid$b <- factor(vapply(parts, `[`, "", 2))
  grand <- mean(grid$y)
  of_a <- ave(grid$y, grid$a) - grand
  of_b <- ave(grid$y, grid$b) - grand
  of_cell <- ave(grid$y, grid$a, grid$b)
  own <- list(of_a, of_b, of_cell - grand - of_a - of_b)[[effect]]
  r <- rank(round(grid$y - of_cell + own, 8))
  table <- anova(lm(r ~ factor(grid$person) + grid$a * grid$b))
  row <- effect + 1
  df <- table[["Df"]][c(row, 5)]
  f <- table[["F value"]][row]
  c(statistic = f, p = pf(f, df[1], df[2], lower.tail = FALSE),
    effect = f * df[1] / (f * df[1] + df[2]), n = nrow(m))
}

describe <- function(y, g, level) {
  v <- number(y)
  v <- v[!is.na(v) & trials[[g]] %in% level]
  q <- quantile(v, c(0.25, 0.75), names = FALSE)
  c(n = length(v), mean = mean(v), sd = sd(v), median = median(v), q1 = q[1], q3 = q[2])
}
person_mean <- function(y, g, levels, place) c(mean = mean(person_means(y, g, levels)[, place]))

confusion <- function(question, g, levels) {
  truth <- trials[[paste0(question, ".truth")]]
  answer <- trials[[paste0(question, ".answer")]]
  keep <- !is.na(truth) & !is.na(answer)
  if (g != "") keep <- keep & trials[[g]] %in% levels
  labels <- sort(unique(c(truth[keep], answer[keep])))
  counts <- table(factor(truth[keep], labels), factor(answer[keep], labels))
  n <- sum(counts)
  p <- sum(diag(counts)) / n
  chance <- sum(rowSums(counts) / n * colSums(counts) / n)
  z <- qnorm(0.975)
  centre <- (p + z^2 / (2 * n)) / (1 + z^2 / n)
  reach <- z * sqrt(p * (1 - p) / n + z^2 / (4 * n^2)) / (1 + z^2 / n)
  c(n = n, accuracy = p, wilson_low = max(0, centre - reach), wilson_high = min(1, centre + reach),
    kappa = (p - chance) / (1 - chance))
}

keys <- character()
names_of <- character()
found <- numeric()
check <- function(key, values) {
  keys <<- c(keys, rep(key, length(values)))
  names_of <<- c(names_of, names(values))
  found <<- c(found, unname(values))
}
# Holm's correction of the p of several checks together.
holm <- function(of, into) {
  # A check that is itself the smallest of several counts with its corrected p.
  own <- function(name) found[match(paste(of, name), paste(keys, names_of))]
  p <- p.adjust(ifelse(is.na(own("p_holm")), own("p"), own("p_holm")), "holm")
  for (i in seq_along(of)) check(into[i], c(p_holm = p[i]))
}

@CALLS@

result <- data.frame(key = keys, name = names_of, value = format(found, digits = 17, trim = TRUE))
write.csv(result, "data/numbers-r.csv", row.names = FALSE, quote = TRUE)
expected <- read.csv("data/numbers.csv", colClasses = c("character", "character", "numeric"),
                     encoding = "UTF-8")
place <- match(paste(expected$key, expected$name, sep = "\r"), paste(keys, names_of, sep = "\r"))
own <- found[place]
size <- pmax(abs(expected$value), abs(own))
far <- is.na(place) | is.na(own) | abs(own - expected$value) > 1e-8 * size + 1e-12 * (size > 1e-10)
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
