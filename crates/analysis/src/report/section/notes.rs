//! How the numbers of a report were computed, and how far they reach.

use std::collections::{BTreeMap, BTreeSet};

use mimique_report::document::Block;

use crate::hypothesis::{ClipScope, reading};
use crate::report::section::Writer;

impl Writer<'_> {
    pub(crate) fn notes(&mut self) {
        let language = self.language();
        self.heading(2, "How this was computed", "Comment cela a été calculé");
        self.paragraph(
            "Recommended: each person’s answers at a level are averaged, so that a person counts once. Several levels: Friedman’s test with Iman and Davenport’s F and Kendall’s W. Pairs: Wilcoxon’s signed rank test, exact and conditional on the observed ranks, zeros by Pratt, Holm’s correction, rank-biserial correlation, Hodges-Lehmann estimate and 95 % interval from the Walsh averages. Interactions: aligned rank transform on person means; with something about people, whether each person’s difference between two levels depends on it.",
            "Recommandé : les réponses de chaque personne à un niveau sont moyennées, de sorte qu’une personne compte une fois. Plusieurs niveaux : test de Friedman, F d’Iman et Davenport, W de Kendall. Paires : test des rangs signés de Wilcoxon, exact et conditionnel aux rangs observés, zéros selon Pratt, correction de Holm, corrélation bisériale des rangs, estimation de Hodges-Lehmann et intervalle à 95 % par les moyennes de Walsh. Interactions : transformation des rangs alignés sur les moyennes des personnes ; avec un facteur propre aux personnes, la différence de chacune entre deux niveaux en dépend-elle.",
        );
        if !self.study.conditions().is_empty() {
            self.paragraph(
                "Between conditions: each person’s answers are averaged to one value; Mann-Whitney of two conditions, Kruskal-Wallis of more.",
                "Entre conditions : les réponses de chaque personne sont moyennées en une seule valeur ; Mann-Whitney pour deux conditions, Kruskal-Wallis au-delà.",
            );
        }
        if self.results.choices.iter().any(|choices| choices.tests.is_some()) {
            self.paragraph(
                "Choices between two clips: of two levels the exact sign test of people (whether more of them choose one more often than the other; who chooses both equally often is left out). Of more, worths by Bradley and Terry’s model, with Davidson’s ties where “no difference” was an answer and a side bias where sides varied: equal worths by Wald’s F on the covariance clustered by participant, with few people by Friedman’s test on each one’s wins; pairs by t clustered by participant, Holm’s correction; intervals are those of the t tests. A just noticeable difference (JND) is ln 3 of worth: 75 % of decided choices. For independent answers: sign test of trials, likelihood ratio.",
                "Choix entre deux extraits : pour deux niveaux, test du signe exact sur les personnes (si davantage choisissent l’un plus souvent que l’autre ; qui choisit les deux aussi souvent n’est pas compté). Au-delà, valeurs selon le modèle de Bradley et Terry, avec les égalités de Davidson si « pas de différence » était une réponse et un biais de côté si les côtés variaient : égalité des valeurs par le F de Wald à covariance groupée par participant, avec peu de personnes par le test de Friedman sur les victoires de chacune ; paires par t groupé par participant, correction de Holm ; les intervalles sont ceux des tests t. Une différence juste perceptible (JND) est ln 3 de valeur : 75 % des choix tranchés. Pour des réponses indépendantes : test du signe sur les essais, rapport de vraisemblance.",
            );
        }
        self.blocks.push(Block::Paragraph(reading::no_proof(language).to_owned()));
        self.paragraph(
            "Effect sizes: r is the matched rank-biserial correlation, W Kendall’s coefficient of concordance, V Cramér’s, ε² is H / (n − 1) of Kruskal-Wallis, η²H the same of Scheirer-Ray-Hare (SRH), ηp² the partial eta squared of the aligned rank transform (ART). r drops participants without a difference; Cliff’s d_w counts them: the share with a positive difference less the share with a negative one, of all, with Bonett and Price’s interval. d_z is the mean difference divided by the standard deviation of the differences, without Hedges’s correction, with the interval of the noncentral t. delta is Cliff’s, with Feng and Cliff’s interval. The interval of W is that of the noncentral chi-square, of Spearman’s rho Bonett and Wright’s.",
            "Tailles d’effet : r est la corrélation bisériale des rangs appariés, W le coefficient de concordance de Kendall, V celui de Cramér, ε² est H / (n − 1) de Kruskal-Wallis, η²H le même de Scheirer-Ray-Hare (SRH), ηp² l’êta carré partiel de la transformation des rangs alignés (ART). r ne compte pas les personnes sans différence ; le d_w de Cliff les compte : la part des différences positives moins celle des négatives, sur toutes, avec l’intervalle de Bonett et Price. d_z est la différence moyenne divisée par l’écart type des différences, sans correction de Hedges, avec l’intervalle du t non centré. delta est celui de Cliff, avec l’intervalle de Feng et Cliff. L’intervalle de W est celui du khi-deux non centré, celui du rho de Spearman est de Bonett et Wright.",
        );
        self.paragraph(
            "Floor and ceiling effects: more than 15 % of at least 20 answers at a level are at the lowest or highest point of the scale (McHorney and Tarlov, 1995; Terwee et al., 2007). Unequal spreads: among levels with at least ten participants, the largest standard deviation of participants’ means is more than twice the smallest.",
            "Effets plancher et plafond : plus de 15 % d’au moins 20 réponses d’un niveau sont au point le plus bas ou le plus haut de l’échelle (McHorney et Tarlov, 1995 ; Terwee et coll., 2007). Dispersions inégales : parmi les niveaux d’au moins dix personnes, le plus grand écart type des moyennes des personnes dépasse le double du plus petit.",
        );
        self.paragraph(
            "As in the thesis: Kruskal-Wallis, Wilcoxon (R of 2019: zeros dropped, exact only below 50 differences without ties and zeros, else normal with continuity correction), Scheirer-Ray-Hare (type I sums of squares, corrected for ties) and chi-square (Yates’s correction for two by two) on single trials.",
            "Comme dans la thèse : Kruskal-Wallis, Wilcoxon (R de 2019 : zéros supprimés, exact seulement sous 50 différences sans ex æquo ni zéros, sinon normal avec correction de continuité), Scheirer-Ray-Hare (sommes de carrés de type I, corrigées des ex æquo) et khi-deux (correction de Yates pour deux par deux) sur les essais pris un à un.",
        );
        let for_others =
            self.results.hypotheses.iter().any(|result| result.scope == ClipScope::Others);
        if self.one_clip_a_cell() && !for_others {
            self.blocks.push(Block::Caution(
                language
                    .pick(
                        "Every combination of factors was shown with one clip only: what is found here holds for these clips, and does not generalise to other performances of the same emotions.",
                        "Chaque combinaison de facteurs n’a été montrée qu’avec un seul extrait : ce qui est trouvé ici vaut pour ces extraits et ne se généralise pas à d’autres interprétations des mêmes émotions.",
                    )
                    .to_owned(),
            ));
        }
    }

    /// Whether every combination of factors was shown with one clip only.
    pub(crate) fn one_clip_a_cell(&self) -> bool {
        let mut clips: BTreeMap<u32, BTreeSet<&str>> = BTreeMap::new();
        let combinations = &self.export.combinations().of_trial;
        for (trial, &cell) in self.export.trials.iter().zip(combinations) {
            clips.entry(cell).or_default().insert(&trial.stimulus);
        }
        clips.values().all(|clips| clips.len() == 1)
    }
}
