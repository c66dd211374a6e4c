# What R's base functions give for random data sets. In: a file of lines
# `test<TAB>numbers of x separated by spaces<TAB>numbers of y or codes`; out: one line of numbers each.
lines <- strsplit(readLines(commandArgs(trailingOnly = TRUE)[1]), "\t", fixed = TRUE)
numbers <- function(text) as.numeric(strsplit(text, " ", fixed = TRUE)[[1]])
run <- function(line) {
  x <- numbers(line[2])
  y <- if (length(line) > 2) numbers(line[3])
  switch(line[1],
    kruskal = { t <- kruskal.test(x, factor(y)); c(t$statistic, t$p.value) },
    wilcoxon = { t <- wilcox.test(x); c(t$statistic, t$p.value) },
    mannwhitney = { t <- wilcox.test(x[y == 0], x[y == 1]); c(t$statistic, t$p.value) },
    spearman = { t <- cor.test(x, y, method = "spearman"); c(t$estimate, t$p.value) },
    chisquare = { t <- chisq.test(table(x, y)); c(t$statistic, t$p.value) },
    friedman = { t <- friedman.test(matrix(x, ncol = 3, byrow = TRUE)); c(t$statistic, t$p.value) },
    srh = {
      r <- rank(x)
      t <- anova(lm(r ~ factor(y %/% 4) * factor(y %% 4)))
      h <- t[["Sum Sq"]][1:3] / var(r)
      c(h, pchisq(h, t[["Df"]][1:3], lower.tail = FALSE))
    })
}
for (line in lines) {
  found <- suppressWarnings(run(line))
  cat(format(unname(found), digits = 17, trim = TRUE), "\n")
}
